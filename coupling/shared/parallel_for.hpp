// A loop over independent pieces of work on several threads.
#pragma once

#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace gasgrain {

// Calls work(n) for n < count, in any order, and after each, by one thread at a time, done(number
// of calls finished). The first exception is thrown on.
template <class Work, class Done>
void parallel_for(std::size_t count, int threads, const Work& work, const Done& done) {
  std::atomic<std::size_t> next{0};
  std::size_t finished = 0;
  std::mutex mutex;
  std::exception_ptr error;
  const auto run = [&] {
    try {
      for (std::size_t n = next++; n < count; n = next++) {
        work(n);
        const std::lock_guard lock(mutex);
        done(++finished);
      }
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!error) error = std::current_exception();
      next = count;
    }
  };
  std::vector<std::thread> others;
  for (int t = 1; t < threads; ++t) others.emplace_back(run);
  run();
  for (std::thread& thread : others) thread.join();
  if (error) std::rethrow_exception(error);
}

}  // namespace gasgrain
