// An HDF5 file, written or read by one process or collectively by those of a communicator.
//
// The only door to HDF5. Every failure of the library becomes a UserError that names the file.
// Close explicitly after writing: a disk that is full may show only then.
#pragma once

#include <mpi.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace gasgrain {

// The part of a dataset that one process writes or reads; slowest index first.
struct ArrayBlock {
  std::vector<std::uint64_t> global;  // size of the whole dataset
  std::vector<std::uint64_t> start;   // first index of the part
  std::vector<std::uint64_t> count;   // its size, may be zero

  // All of a dataset of that size.
  static ArrayBlock whole(const std::vector<std::uint64_t>& size);
};

class Hdf5File {
 public:
  // One process alone. create() replaces a file that is there.
  static Hdf5File create(const std::string& path);
  static Hdf5File open(const std::string& path);  // to read
  // Collective over `comm`, and so is every later call on the file.
  static Hdf5File create(const std::string& path, MPI_Comm comm);
  static Hdf5File open(const std::string& path, MPI_Comm comm);

  Hdf5File(Hdf5File&& other) noexcept;
  Hdf5File& operator=(Hdf5File&& other) noexcept;
  Hdf5File(const Hdf5File&) = delete;
  Hdf5File& operator=(const Hdf5File&) = delete;
  ~Hdf5File();

  // Hands everything written so far to the operating system (of all ranks, when collective).
  void flush();
  void close();

  // T: double, float, std::int16_t, std::int32_t or std::int64_t. Attributes belong to the root
  // group, same value on every rank; missing groups of a dataset's path are created.
  template <class T>
  void write_attribute(const std::string& name, const std::vector<T>& values);
  void write_attribute(const std::string& name, const std::string& text);
  template <class T>
  void write(const std::string& dataset, const ArrayBlock& block, const T* values);
  // A text of any length, same on every rank; an attribute holds at most 64 kB.
  void write_text(const std::string& dataset, const std::string& text);

  template <class T>
  std::vector<T> attribute(const std::string& name) const;
  std::string text_attribute(const std::string& name) const;
  bool has_attribute(const std::string& name) const;
  std::vector<std::uint64_t> size(const std::string& dataset) const;
  template <class T>
  void read(const std::string& dataset, const ArrayBlock& block, T* values) const;
  // The whole dataset.
  template <class T>
  std::vector<T> read(const std::string& dataset) const;
  // First byte of a dataset that lies in the file as numbers T lie in memory; nothing when it is
  // packed or converted.
  template <class T>
  std::optional<std::uint64_t> place_in_file(const std::string& dataset) const;
  std::string read_text(const std::string& dataset) const;

 private:
  enum class Access { serial, collective };
  Hdf5File(std::string path, Access access, std::int64_t id);
  [[noreturn]] void fail(const std::string& action) const;
  void check_block(const ArrayBlock& block) const;

  std::string path_;
  Access access_;
  std::int64_t id_;  // HDF5's identifier of the file, or -1
};

}  // namespace gasgrain
