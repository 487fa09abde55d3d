#include "coupling/shared/stop_signal.hpp"

#include <signal.h>

#include <array>

#include "coupling/shared/error.hpp"

namespace gasgrain {

namespace {

constexpr std::array signals{SIGTERM, SIGINT, SIGUSR1};

volatile sig_atomic_t raised_signal = 0;
std::array<struct sigaction, signals.size()> former;
bool in_use = false;

void note(int signal) {
  raised_signal = signal;
}

}  // namespace

StopSignal::StopSignal() {
  GASGRAIN_ASSERT(!in_use);
  in_use = true;
  raised_signal = 0;
  struct sigaction action {};
  action.sa_handler = note;
  action.sa_flags = SA_RESTART | static_cast<int>(SA_RESETHAND);
  sigemptyset(&action.sa_mask);
  for (std::size_t n = 0; n < signals.size(); ++n) sigaction(signals[n], &action, &former[n]);
}

StopSignal::~StopSignal() {
  for (std::size_t n = 0; n < signals.size(); ++n) sigaction(signals[n], &former[n], nullptr);
  in_use = false;
}

bool StopSignal::raised() const {
  return raised_signal != 0;
}

}  // namespace gasgrain
