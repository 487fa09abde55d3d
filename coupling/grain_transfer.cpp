// Sparse rank-to-rank exchange: every rank tells every other how many grains to expect (one integer
// per pair), then only pairs that share grains exchange messages. Received messages are stored in
// rank order whatever their order of arrival, so results repeat bit for bit.
#include "coupling/grain_transfer.hpp"

#include <cmath>

#include "coupling/shared/error.hpp"

namespace gasgrain::coupling {

namespace {

constexpr int grain_tag = 41, result_tag = 42;

// `position` shifted by whole periods into the grid, in periodic directions.
Vec3 wrapped(Vec3 position, const cfd::Decomposition& decomposition) {
  const cfd::Grid& grid = decomposition.grid();
  for (int d = 0; d < 3; ++d) {
    if (!decomposition.periodic()[d]) continue;
    const double period = grid.upper[d] - grid.lower[d];
    position[d] -= period * std::floor((position[d] - grid.lower[d]) / period);
    if (position[d] >= grid.upper[d]) position[d] = grid.lower[d];  // rounding of the line above
  }
  return position;
}

bool inside(const cfd::Grid& grid, const cfd::Index3& cell) {
  for (int d = 0; d < 3; ++d) {
    if (cell[d] < 0 || cell[d] >= grid.cells[d]) return false;
  }
  return true;
}

// Sends and receives arrays of T between partners; buffers are indexed by the partners' ranges.
template <class T, class Partners>
void exchange_messages(MPI_Comm communicator, int tag, const Partners& to, const T* send,
                       const Partners& from, T* receive) {
  std::vector<MPI_Request> requests(to.size() + from.size());
  std::size_t r = 0;
  const auto bytes = [](const auto& partner) {
    const std::size_t count = (partner.end - partner.begin) * sizeof(T);
    GASGRAIN_ASSERT(count <= 2147483647u);
    return static_cast<int>(count);
  };
  for (const auto& partner : from) {
    MPI_Irecv(receive + partner.begin, bytes(partner), MPI_BYTE, partner.rank, tag, communicator,
              &requests[r++]);
  }
  for (const auto& partner : to) {
    MPI_Isend(send + partner.begin, bytes(partner), MPI_BYTE, partner.rank, tag, communicator,
              &requests[r++]);
  }
  MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
}

}  // namespace

double grain_diameter(const GrainRecord& grain) {
  return std::cbrt(6.0 * grain.volume / M_PI);
}

void GrainTransfer::send(std::span<const GrainRecord> local) {
  const int ranks = decomposition_.size();
  const cfd::Grid& grid = decomposition_.grid();
  std::vector<int> owners(local.size(), -1), send_counts(ranks, 0), receive_counts(ranks, 0);
  for (std::size_t n = 0; n < local.size(); ++n) {
    const cfd::Index3 cell = grid.cell_of(wrapped(local[n].position, decomposition_));
    if (!inside(grid, cell)) continue;
    owners[n] = decomposition_.owner(cell);
    ++send_counts[owners[n]];
  }
  MPI_Alltoall(send_counts.data(), 1, MPI_INT, receive_counts.data(), 1, MPI_INT,
               decomposition_.communicator());

  const auto partners = [](const std::vector<int>& counts) {
    std::vector<Partner> result;
    std::size_t begin = 0;
    for (std::size_t rank = 0; rank < counts.size(); ++rank) {
      if (counts[rank] == 0) continue;
      result.push_back({static_cast<int>(rank), begin, begin + counts[rank]});
      begin += counts[rank];
    }
    return result;
  };
  destinations_ = partners(send_counts);
  sources_ = partners(receive_counts);
  const std::size_t sent = destinations_.empty() ? 0 : destinations_.back().end;
  const std::size_t received = sources_.empty() ? 0 : sources_.back().end;
  outside_ = static_cast<long>(local.size() - sent);

  std::vector<std::size_t> next(ranks, 0);
  for (const Partner& partner : destinations_) next[partner.rank] = partner.begin;
  send_order_.resize(sent);
  for (std::size_t n = 0; n < local.size(); ++n) {
    if (owners[n] >= 0) send_order_[next[owners[n]]++] = n;
  }
  std::vector<GrainRecord> buffer(sent);
  for (std::size_t n = 0; n < sent; ++n) {
    buffer[n] = local[send_order_[n]];
    buffer[n].position = wrapped(buffer[n].position, decomposition_);
  }
  received_.resize(received);
  exchange_messages(decomposition_.communicator(), grain_tag, destinations_, buffer.data(),
                    sources_, received_.data());
}

std::vector<double> GrainTransfer::send_along(std::span<const double> local) const {
  std::vector<double> buffer(send_order_.size()), result(received_.size());
  for (std::size_t n = 0; n < send_order_.size(); ++n) buffer[n] = local[send_order_[n]];
  exchange_messages(decomposition_.communicator(), grain_tag, destinations_, buffer.data(),
                    sources_, result.data());
  return result;
}

void GrainTransfer::return_to_senders(std::span<Vec3> local, std::span<const Vec3> results) const {
  send_back(local, results);
}

void GrainTransfer::return_to_senders(std::span<double> local,
                                      std::span<const double> results) const {
  send_back(local, results);
}

template <class T>
void GrainTransfer::send_back(std::span<T> local, std::span<const T> results) const {
  GASGRAIN_ASSERT(results.size() == received_.size());
  std::vector<T> buffer(send_order_.size());
  exchange_messages(decomposition_.communicator(), result_tag, sources_, results.data(),
                    destinations_, buffer.data());
  for (std::size_t n = 0; n < send_order_.size(); ++n) local[send_order_[n]] = buffer[n];
}

}  // namespace gasgrain::coupling
