// A file's bytes as memory: pages are read when they are touched and shared by all processes of the
// machine that map the same file.
#pragma once

#include <cstdint>
#include <string>

#include "coupling/shared/shared_array.hpp"

namespace gasgrain {

// `count` numbers of the file from byte `place` on, which must be a multiple of their alignment.
// UserError when the file cannot be opened or is shorter. The file may be replaced or removed while
// they are in use, but not be shortened.
template <class T>
SharedArray<T> mapped_array(const std::string& path, std::uint64_t place, std::uint64_t count);

}  // namespace gasgrain
