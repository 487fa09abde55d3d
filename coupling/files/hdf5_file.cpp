// RAII over HDF5's C interface: identifiers close themselves, error codes become exceptions.
#include "coupling/files/hdf5_file.hpp"

#include <hdf5.h>

#include <cstring>
#include <functional>
#include <numeric>
#include <utility>

#include "coupling/shared/error.hpp"

namespace gasgrain {

namespace {

static_assert(sizeof(hid_t) == sizeof(std::int64_t));

// An identifier with the function that closes it.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  operator hid_t() const { return id_; }
  bool valid() const { return id_ >= 0; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

// Keeps HDF5 from printing its error stack while it lives; we report it in our own message.
class QuietErrors {
 public:
  QuietErrors() {
    H5Eget_auto2(H5E_DEFAULT, &print_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  QuietErrors(const QuietErrors&) = delete;
  QuietErrors& operator=(const QuietErrors&) = delete;
  ~QuietErrors() { H5Eset_auto2(H5E_DEFAULT, print_, data_); }

 private:
  H5E_auto2_t print_ = nullptr;
  void* data_ = nullptr;
};

// The innermost description on HDF5's error stack.
std::string innermost_error() {
  std::string text;
  const auto visit = [](unsigned, const H5E_error2_t* error, void* out) -> herr_t {
    *static_cast<std::string*>(out) = error->desc ? error->desc : "";
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_DOWNWARD, visit, &text);
  return text;
}

[[noreturn]] void fail_at(const std::string& path, const std::string& action,
                          const std::string& remedy) {
  const std::string reason = innermost_error();
  throw UserError("HDF5 file '" + path + "': cannot " + action +
                  (reason.empty() ? "" : " (" + reason + ")") + "; " + remedy);
}

[[noreturn]] void fail_to_write(const std::string& path, const std::string& action) {
  fail_at(path, action, "check that the path exists, is ours to write and the disk is not full");
}

[[noreturn]] void fail_to_read(const std::string& path, const std::string& action) {
  fail_at(path, action, "check that it is the right file, readable and whole");
}

template <class T>
hid_t memory_type();
template <>
hid_t memory_type<double>() {
  return H5T_NATIVE_DOUBLE;
}
template <>
hid_t memory_type<float>() {
  return H5T_NATIVE_FLOAT;
}
template <>
hid_t memory_type<std::int16_t>() {
  return H5T_NATIVE_INT16;
}
template <>
hid_t memory_type<std::int32_t>() {
  return H5T_NATIVE_INT32;
}
template <>
hid_t memory_type<std::int64_t>() {
  return H5T_NATIVE_INT64;
}

// A string of `size` bytes, the closing zero included.
Handle text_type(std::size_t size) {
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, size);
  return {type, H5Tclose};
}

// Access properties: through MPI when there is a communicator.
class FileAccess {
 public:
  explicit FileAccess(const MPI_Comm* comm) : list_(H5Pcreate(H5P_FILE_ACCESS), H5Pclose) {
    if (comm) H5Pset_fapl_mpio(list_, *comm, MPI_INFO_NULL);
  }
  operator hid_t() const { return list_; }

 private:
  Handle list_;
};

hid_t create_file(const std::string& path, const MPI_Comm* comm) {
  const QuietErrors quiet;
  const FileAccess access(comm);
  const hid_t id = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access);
  if (id < 0) fail_to_write(path, "create the file");
  return id;
}

hid_t open_file(const std::string& path, const MPI_Comm* comm) {
  const QuietErrors quiet;
  const FileAccess access(comm);
  const hid_t id = H5Fopen(path.c_str(), H5F_ACC_RDONLY, access);
  if (id < 0) fail_to_read(path, "open the file");
  return id;
}

std::uint64_t product(const std::vector<std::uint64_t>& size) {
  return std::accumulate(size.begin(), size.end(), std::uint64_t{1}, std::multiplies<>());
}

// Dataspaces of one process's part in the file and in memory, and how to transfer it.
struct Selection {
  Handle file, memory, transfer;
  bool valid = true;

  Selection(const ArrayBlock& block, bool collective)
      : file(H5Screate_simple(static_cast<int>(block.global.size()),
                              reinterpret_cast<const hsize_t*>(block.global.data()), nullptr),
             H5Sclose),
        memory(H5Screate_simple(static_cast<int>(block.count.size()),
                                reinterpret_cast<const hsize_t*>(block.count.data()), nullptr),
               H5Sclose),
        transfer(H5Pcreate(H5P_DATASET_XFER), H5Pclose) {
    static_assert(sizeof(hsize_t) == sizeof(std::uint64_t));
    if (product(block.count) == 0) {
      valid = H5Sselect_none(file) >= 0 && H5Sselect_none(memory) >= 0;
    } else {
      valid = H5Sselect_hyperslab(
                  file, H5S_SELECT_SET, reinterpret_cast<const hsize_t*>(block.start.data()),
                  nullptr, reinterpret_cast<const hsize_t*>(block.count.data()), nullptr) >= 0;
    }
    if (collective) valid = valid && H5Pset_dxpl_mpio(transfer, H5FD_MPIO_COLLECTIVE) >= 0;
  }
};

}  // namespace

ArrayBlock ArrayBlock::whole(const std::vector<std::uint64_t>& size) {
  return {.global = size, .start = std::vector<std::uint64_t>(size.size(), 0), .count = size};
}

Hdf5File::Hdf5File(std::string path, Access access, std::int64_t id)
    : path_(std::move(path)), access_(access), id_(id) {}

Hdf5File Hdf5File::create(const std::string& path) {
  return {path, Access::serial, create_file(path, nullptr)};
}
Hdf5File Hdf5File::open(const std::string& path) {
  return {path, Access::serial, open_file(path, nullptr)};
}
Hdf5File Hdf5File::create(const std::string& path, MPI_Comm comm) {
  return {path, Access::collective, create_file(path, &comm)};
}
Hdf5File Hdf5File::open(const std::string& path, MPI_Comm comm) {
  return {path, Access::collective, open_file(path, &comm)};
}

Hdf5File::Hdf5File(Hdf5File&& other) noexcept
    : path_(std::move(other.path_)),
      access_(other.access_),
      id_(std::exchange(other.id_, std::int64_t{-1})) {}

Hdf5File& Hdf5File::operator=(Hdf5File&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(access_, other.access_);
  std::swap(id_, other.id_);
  return *this;
}

Hdf5File::~Hdf5File() {
  if (id_ >= 0) {
    const QuietErrors quiet;
    H5Fclose(id_);
  }
}

void Hdf5File::flush() {
  const QuietErrors quiet;
  if (H5Fflush(id_, H5F_SCOPE_GLOBAL) < 0) fail("write out the file");
}

void Hdf5File::close() {
  const QuietErrors quiet;
  if (H5Fclose(std::exchange(id_, std::int64_t{-1})) < 0) fail("close the file");
}

void Hdf5File::fail(const std::string& action) const {
  fail_to_write(path_, action);
}

void Hdf5File::check_block(const ArrayBlock& block) const {
  const std::size_t rank = block.global.size();
  GASGRAIN_ASSERT(rank > 0 && block.start.size() == rank && block.count.size() == rank);
  for (std::size_t d = 0; d < rank; ++d) {
    GASGRAIN_ASSERT(block.start[d] + block.count[d] <= block.global[d]);
  }
}

template <class T>
void Hdf5File::write_attribute(const std::string& name, const std::vector<T>& values) {
  const QuietErrors quiet;
  const hsize_t size = values.size();
  const Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose);
  const Handle attribute(
      H5Acreate2(id_, name.c_str(), memory_type<T>(), space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  if (!attribute.valid() || H5Awrite(attribute, memory_type<T>(), values.data()) < 0) {
    fail("write attribute '" + name + "'");
  }
}

void Hdf5File::write_attribute(const std::string& name, const std::string& text) {
  const QuietErrors quiet;
  const Handle type = text_type(text.size() + 1);
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle attribute(H5Acreate2(id_, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT),
                         H5Aclose);
  if (!attribute.valid() || H5Awrite(attribute, type, text.c_str()) < 0) {
    fail("write attribute '" + name + "'");
  }
}

template <class T>
void Hdf5File::write(const std::string& dataset, const ArrayBlock& block, const T* values) {
  check_block(block);
  const QuietErrors quiet;
  const Handle link(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  H5Pset_create_intermediate_group(link, 1);
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_fill_time(creation, H5D_FILL_TIME_NEVER);  // every value is written
  H5Pset_obj_track_times(creation, false);          // same data, same bytes
  const Selection selection(block, access_ == Access::collective);
  const Handle set(H5Dcreate2(id_, dataset.c_str(), memory_type<T>(), selection.file, link,
                              creation, H5P_DEFAULT),
                   H5Dclose);
  if (!selection.valid || !set.valid()) fail("create dataset '" + dataset + "'");
  if (product(block.global) == 0) return;
  if (H5Dwrite(set, memory_type<T>(), selection.memory, selection.file, selection.transfer,
               values) < 0) {
    fail("write dataset '" + dataset + "'");
  }
}

void Hdf5File::write_text(const std::string& dataset, const std::string& text) {
  const QuietErrors quiet;
  const Handle type = text_type(text.size() + 1);
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(creation, false);
  const Handle set(
      H5Dcreate2(id_, dataset.c_str(), type, space, H5P_DEFAULT, creation, H5P_DEFAULT), H5Dclose);
  if (!set.valid() || H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.c_str()) < 0) {
    fail("write text '" + dataset + "'");
  }
}

bool Hdf5File::has_attribute(const std::string& name) const {
  const QuietErrors quiet;
  return H5Aexists(id_, name.c_str()) > 0;
}

template <class T>
std::vector<T> Hdf5File::attribute(const std::string& name) const {
  const QuietErrors quiet;
  const Handle attribute(H5Aopen(id_, name.c_str(), H5P_DEFAULT), H5Aclose);
  if (!attribute.valid()) fail_to_read(path_, "find attribute '" + name + "'");
  const Handle space(H5Aget_space(attribute), H5Sclose);
  std::vector<T> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
  if (H5Aread(attribute, memory_type<T>(), values.data()) < 0) {
    fail_to_read(path_, "read attribute '" + name + "'");
  }
  return values;
}

std::string Hdf5File::text_attribute(const std::string& name) const {
  const QuietErrors quiet;
  const Handle attribute(H5Aopen(id_, name.c_str(), H5P_DEFAULT), H5Aclose);
  if (!attribute.valid()) fail_to_read(path_, "find attribute '" + name + "'");
  const Handle type(H5Aget_type(attribute), H5Tclose);
  const std::size_t size = H5Tget_class(type) == H5T_STRING ? H5Tget_size(type) : 0;
  if (size == 0 || H5Tis_variable_str(type) != 0)
    fail_to_read(path_, "read attribute '" + name + "' as text");
  std::string text(size, '\0');
  if (H5Aread(attribute, type, text.data()) < 0)
    fail_to_read(path_, "read attribute '" + name + "'");
  text.resize(std::strlen(text.c_str()));
  return text;
}

std::vector<std::uint64_t> Hdf5File::size(const std::string& dataset) const {
  const QuietErrors quiet;
  const Handle set(H5Dopen2(id_, dataset.c_str(), H5P_DEFAULT), H5Dclose);
  if (!set.valid()) fail_to_read(path_, "find dataset '" + dataset + "'");
  const Handle space(H5Dget_space(set), H5Sclose);
  std::vector<std::uint64_t> result(static_cast<std::size_t>(H5Sget_simple_extent_ndims(space)));
  H5Sget_simple_extent_dims(space, reinterpret_cast<hsize_t*>(result.data()), nullptr);
  return result;
}

namespace {

// Whether the file holds all values that the dataset claims; a damaged size must not take memory.
bool is_stored(hid_t file, const std::string& dataset, const ArrayBlock& block) {
  const QuietErrors quiet;
  const Handle set(H5Dopen2(file, dataset.c_str(), H5P_DEFAULT), H5Dclose);
  hsize_t bytes = 0;
  if (!set.valid() || H5Fget_filesize(file, &bytes) < 0) return false;
  const Handle type(H5Dget_type(set), H5Tclose);
  double claimed = static_cast<double>(H5Tget_size(type));
  for (const std::uint64_t n : block.global) claimed *= static_cast<double>(n);
  return claimed <= static_cast<double>(bytes);
}

}  // namespace

template <class T>
void Hdf5File::read(const std::string& dataset, const ArrayBlock& block, T* values) const {
  check_block(block);
  if (size(dataset) != block.global)
    fail_to_read(path_, "read dataset '" + dataset + "', its size differs");
  if (product(block.global) == 0) return;
  const QuietErrors quiet;
  const Handle set(H5Dopen2(id_, dataset.c_str(), H5P_DEFAULT), H5Dclose);
  const Selection selection(block, access_ == Access::collective);
  if (!set.valid() || !selection.valid ||
      H5Dread(set, memory_type<T>(), selection.memory, selection.file, selection.transfer, values) <
          0) {
    fail_to_read(path_, "read dataset '" + dataset + "'");
  }
}

template <class T>
std::vector<T> Hdf5File::read(const std::string& dataset) const {
  const ArrayBlock block = ArrayBlock::whole(size(dataset));
  if (!is_stored(id_, dataset, block))
    fail_to_read(path_, "read dataset '" + dataset + "', its size is damaged");
  std::vector<T> values(product(block.global));
  read(dataset, block, values.data());
  return values;
}

template <class T>
std::optional<std::uint64_t> Hdf5File::place_in_file(const std::string& dataset) const {
  const QuietErrors quiet;
  const Handle set(H5Dopen2(id_, dataset.c_str(), H5P_DEFAULT), H5Dclose);
  if (!set.valid()) fail("find dataset '" + dataset + "'");
  const Handle type(H5Dget_type(set), H5Tclose);
  const haddr_t place = H5Dget_offset(set);
  if (place == HADDR_UNDEF || place % alignof(T) != 0 || H5Tequal(type, memory_type<T>()) <= 0)
    return std::nullopt;
  return place;
}

std::string Hdf5File::read_text(const std::string& dataset) const {
  const QuietErrors quiet;
  const Handle set(H5Dopen2(id_, dataset.c_str(), H5P_DEFAULT), H5Dclose);
  if (!set.valid()) fail_to_read(path_, "find text '" + dataset + "'");
  const Handle type(H5Dget_type(set), H5Tclose);
  const std::size_t size = H5Tget_class(type) == H5T_STRING ? H5Tget_size(type) : 0;
  if (size == 0 || H5Tis_variable_str(type) != 0)
    fail_to_read(path_, "read '" + dataset + "' as text");
  std::string text(size, '\0');
  if (H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()) < 0) {
    fail_to_read(path_, "read text '" + dataset + "'");
  }
  text.resize(std::strlen(text.c_str()));
  return text;
}

#define GASGRAIN_HDF5_TYPE(T)                                                         \
  template void Hdf5File::write_attribute(const std::string&, const std::vector<T>&); \
  template void Hdf5File::write(const std::string&, const ArrayBlock&, const T*);     \
  template std::vector<T> Hdf5File::attribute(const std::string&) const;              \
  template void Hdf5File::read(const std::string&, const ArrayBlock&, T*) const;      \
  template std::vector<T> Hdf5File::read(const std::string&) const;                   \
  template std::optional<std::uint64_t> Hdf5File::place_in_file<T>(const std::string&) const;
GASGRAIN_HDF5_TYPE(double)
GASGRAIN_HDF5_TYPE(float)
GASGRAIN_HDF5_TYPE(std::int16_t)
GASGRAIN_HDF5_TYPE(std::int32_t)
GASGRAIN_HDF5_TYPE(std::int64_t)
#undef GASGRAIN_HDF5_TYPE

}  // namespace gasgrain
