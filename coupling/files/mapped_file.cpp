#include "coupling/files/mapped_file.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstring>

#include "coupling/shared/error.hpp"

namespace gasgrain {

namespace {

[[noreturn]] void fail(const std::string& path, const std::string& why) {
  throw UserError("cannot map '" + path + "' into memory: " + why);
}

struct OpenFile {
  int descriptor;

  explicit OpenFile(const std::string& path) : descriptor(open(path.c_str(), O_RDONLY)) {
    if (descriptor < 0) fail(path, std::strerror(errno));
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  ~OpenFile() { close(descriptor); }
};

}  // namespace

template <class T>
SharedArray<T> mapped_array(const std::string& path, std::uint64_t place, std::uint64_t count) {
  GASGRAIN_ASSERT(place % alignof(T) == 0);
  const OpenFile file(path);
  struct stat status {};
  if (fstat(file.descriptor, &status) != 0) fail(path, std::strerror(errno));
  const auto size = static_cast<std::uint64_t>(status.st_size);
  if (place > size || count > (size - place) / sizeof(T)) fail(path, "it is too short");
  if (count == 0) return {};
  void* bytes = mmap(nullptr, size, PROT_READ, MAP_SHARED, file.descriptor, 0);
  if (bytes == MAP_FAILED) fail(path, std::strerror(errno));
  const std::shared_ptr<const void> owner(bytes, [size](void* mapped) { munmap(mapped, size); });
  const auto* first = reinterpret_cast<const T*>(static_cast<const std::byte*>(bytes) + place);
  return {owner, {first, count}};
}

template SharedArray<float> mapped_array(const std::string&, std::uint64_t, std::uint64_t);
template SharedArray<std::int16_t> mapped_array(const std::string&, std::uint64_t, std::uint64_t);

}  // namespace gasgrain
