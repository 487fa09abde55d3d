#include "liggghts_plugins/engine/ghost_exchange.hpp"

#include <comm.h>
#include <domain.h>
#include <lammps.h>

#include "liggghts_plugins/private_member.hpp"

namespace gasgrain::plugins {

using LAMMPS_NS::Comm;

struct SwapCount {
  using Member = int Comm::*;
  friend Member private_member(SwapCount);
};
#define GASGRAIN_COMM_MEMBER(Tag, Type) \
  struct Tag {                          \
    using Member = Type Comm::*;        \
    friend Member private_member(Tag);  \
  }
GASGRAIN_COMM_MEMBER(SendNumber, int*);
GASGRAIN_COMM_MEMBER(ReceiveNumber, int*);
GASGRAIN_COMM_MEMBER(SendRank, int*);
GASGRAIN_COMM_MEMBER(ReceiveRank, int*);
GASGRAIN_COMM_MEMBER(FirstReceived, int*);
GASGRAIN_COMM_MEMBER(SendList, int**);
GASGRAIN_COMM_MEMBER(PeriodicFlag, int*);
GASGRAIN_COMM_MEMBER(PeriodicShift, int**);
#undef GASGRAIN_COMM_MEMBER

template struct GrantAccess<SwapCount, &Comm::nswap>;
template struct GrantAccess<SendNumber, &Comm::sendnum>;
template struct GrantAccess<ReceiveNumber, &Comm::recvnum>;
template struct GrantAccess<SendRank, &Comm::sendproc>;
template struct GrantAccess<ReceiveRank, &Comm::recvproc>;
template struct GrantAccess<FirstReceived, &Comm::firstrecv>;
template struct GrantAccess<SendList, &Comm::sendlist>;
template struct GrantAccess<PeriodicFlag, &Comm::pbc_flag>;
template struct GrantAccess<PeriodicShift, &Comm::pbc>;

namespace {

constexpr int values_per_grain = 9;

void pack(double* buffer, const GrainRecord& grain, const SpinRecord& spin, const Vec3& shift) {
  for (int d = 0; d < 3; ++d) {
    buffer[d] = grain.position[d] + shift[d];
    buffer[3 + d] = grain.velocity[d];
    buffer[6 + d] = spin.velocity[d];
  }
}

void unpack(GrainRecord& grain, SpinRecord& spin, const double* buffer) {
  for (int d = 0; d < 3; ++d) {
    grain.position[d] = buffer[d];
    grain.velocity[d] = buffer[3 + d];
    spin.velocity[d] = buffer[6 + d];
  }
}

}  // namespace

void GhostExchange::load(LAMMPS_NS::LAMMPS& lmp) {
  const Comm& comm = *lmp.comm;
  world_ = lmp.world;
  rank_ = comm.me;
  swaps_.resize(comm.*private_member(SwapCount()));
  std::size_t most = 0;
  for (std::size_t s = 0; s < swaps_.size(); ++s) {
    Swap& swap = swaps_[s];
    const int* list = (comm.*private_member(SendList()))[s];
    swap.sent.assign(list, list + (comm.*private_member(SendNumber()))[s]);
    swap.first_received = (comm.*private_member(FirstReceived()))[s];
    swap.received_count = (comm.*private_member(ReceiveNumber()))[s];
    swap.send_rank = (comm.*private_member(SendRank()))[s];
    swap.receive_rank = (comm.*private_member(ReceiveRank()))[s];
    swap.shift.setZero();
    if ((comm.*private_member(PeriodicFlag()))[s])
      for (int d = 0; d < 3; ++d)
        swap.shift[d] = (comm.*private_member(PeriodicShift()))[s][d] * lmp.domain->prd[d];
    most = std::max({most, swap.sent.size(), static_cast<std::size_t>(swap.received_count)});
  }
  send_buffer_.resize(values_per_grain * most);
  receive_buffer_.resize(values_per_grain * most);
}

void GhostExchange::update_ghosts(GrainLoop& loop) {
  for (const Swap& swap : swaps_) {
    double* place = send_buffer_.data();
    for (const int i : swap.sent) {
      pack(place, loop.grain(i), loop.spin(i), swap.shift);
      place += values_per_grain;
    }
    const double* received = send_buffer_.data();
    if (swap.send_rank != rank_) {
      received = receive_buffer_.data();
      MPI_Sendrecv(send_buffer_.data(), values_per_grain * static_cast<int>(swap.sent.size()),
                   MPI_DOUBLE, swap.send_rank, 0, receive_buffer_.data(),
                   values_per_grain * swap.received_count, MPI_DOUBLE, swap.receive_rank, 0, world_,
                   MPI_STATUS_IGNORE);
    }
    for (int n = 0; n < swap.received_count; ++n)
      unpack(loop.grain(swap.first_received + n), loop.spin(swap.first_received + n),
             received + values_per_grain * static_cast<std::size_t>(n));
  }
}

}  // namespace gasgrain::plugins
