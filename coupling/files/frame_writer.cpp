// Frames are written to a temporary name, closed, renamed, and only then entered in the index,
// which is itself replaced by a rename.
#include "coupling/files/frame_writer.hpp"

#include <cctype>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numeric>
#include <utility>

#include "coupling/files/collective_error.hpp"
#include "coupling/files/hdf5_file.hpp"
#include "coupling/files/output_directory.hpp"
#include "coupling/files/xdmf.hpp"
#include "coupling/shared/error.hpp"

namespace gasgrain {

namespace {

bool is_identifier(const std::string& name) {
  for (const char c : name) {
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '_') return false;
  }
  return !name.empty();
}

void check_arrays(const std::vector<NamedArray>& arrays) {
  for (const NamedArray& array : arrays) {
    GASGRAIN_ASSERT(is_identifier(array.name));
    GASGRAIN_ASSERT(array.components == 1 || array.components == 3);
  }
}

ArrayBlock cell_block(const GridFrame& frame) {
  ArrayBlock block;
  for (int d = 2; d >= 0; --d) {
    GASGRAIN_ASSERT(frame.block_lower[d] >= 0 && frame.block_cells[d] >= 0);
    block.global.push_back(static_cast<std::uint64_t>(frame.cells[d]));
    block.start.push_back(static_cast<std::uint64_t>(frame.block_lower[d]));
    block.count.push_back(static_cast<std::uint64_t>(frame.block_cells[d]));
  }
  return block;
}

// This rank's grains follow those of the lower ranks.
ArrayBlock grain_block(MPI_Comm comm, std::size_t count) {
  const std::uint64_t here = count;
  std::uint64_t before = 0, total = 0;
  MPI_Scan(&here, &before, 1, MPI_UINT64_T, MPI_SUM, comm);
  MPI_Allreduce(&here, &total, 1, MPI_UINT64_T, MPI_SUM, comm);
  return {.global = {total}, .start = {before - here}, .count = {here}};
}

ArrayBlock with_components(ArrayBlock block, int components) {
  if (components == 1) return block;
  block.global.push_back(static_cast<std::uint64_t>(components));
  block.start.push_back(0);
  block.count.push_back(static_cast<std::uint64_t>(components));
  return block;
}

// Each grain is a cell of one vertex. The vertex numbers are spelt out because ParaView's Xdmf3
// reader makes no cells without them.
std::vector<std::int64_t> vertices(const ArrayBlock& block) {
  std::vector<std::int64_t> result(block.count.front());
  std::iota(result.begin(), result.end(), static_cast<std::int64_t>(block.start.front()));
  return result;
}

// Writes the arrays over the cells or grains of `block` into the frame `file`; returns their XML.
std::string write_arrays(Hdf5File& out, const std::string& file, const ArrayBlock& block,
                         const std::vector<NamedArray>& arrays, xdmf::Center center) {
  std::string xml;
  for (const NamedArray& array : arrays) {
    const ArrayBlock values = with_components(block, array.components);
    out.write(array.name, values, array.values);
    xml += xdmf::attribute(array.name, array.components, center,
                           xdmf::hdf_item(file + ":/" + array.name, values.global));
  }
  return xml;
}

void replace_file(const std::string& part, const std::string& path) {
  std::error_code error;
  std::filesystem::rename(part, path, error);
  if (error) throw UserError("cannot write '" + path + "': " + error.message());
}

}  // namespace

FrameWriter::FrameWriter(MPI_Comm comm, std::string directory, std::string name, Series series)
    : comm_(comm), directory_(std::move(directory)), name_(std::move(name)) {
  GASGRAIN_ASSERT(is_identifier(name_));
  MPI_Comm_rank(comm_, &rank_);
  run_collectively(comm_, [this] {
    if (rank_ == 0) make_output_directory(directory_);
  });
  run_collectively(comm_, [this] { read_index(); });
  if (series == Series::start_new) drop_frames_from(-std::numeric_limits<double>::infinity());
}

void FrameWriter::write(double time, const GridFrame& frame) {
  check_arrays(frame.arrays);
  const ArrayBlock block = cell_block(frame);
  const int number = begin_frame(time);
  const std::string file = file_name(number);
  std::string xml = xdmf::grid_mesh(frame.cells, frame.lower, frame.spacing);
  run_collectively(comm_, [&] {
    Hdf5File out = Hdf5File::create(path(file) + ".part", comm_);
    out.write_attribute<double>("time", {time});
    xml += write_arrays(out, file, block, frame.arrays, xdmf::Center::cell);
    out.close();
  });
  finish_frame(time, number, xdmf::frame(time, xml));
}

void FrameWriter::write(double time, const PointFrame& frame) {
  check_arrays(frame.arrays);
  const ArrayBlock block = grain_block(comm_, frame.count);
  const ArrayBlock positions = with_components(block, 3);
  const int number = begin_frame(time);
  const std::string file = file_name(number);
  std::string xml = xdmf::grain_mesh(file, block.global.front()) +
                    xdmf::attribute("id", 1, xdmf::Center::grain,
                                    xdmf::hdf_item(file + ":/id", block.global, xdmf::integer));
  run_collectively(comm_, [&] {
    Hdf5File out = Hdf5File::create(path(file) + ".part", comm_);
    out.write_attribute<double>("time", {time});
    out.write("position", positions, frame.positions);
    out.write("id", block, frame.ids);
    out.write("vertex", block, vertices(block).data());
    xml += write_arrays(out, file, block, frame.arrays, xdmf::Center::grain);
    out.close();
  });
  finish_frame(time, number, xdmf::frame(time, xml));
}

std::vector<double> FrameWriter::times() const {
  std::vector<double> result;
  for (const Entry& entry : entries_) result.push_back(entry.time);
  return result;
}

int FrameWriter::begin_frame(double time) {
  drop_frames_from(time);
  return entries_.empty() ? 0 : entries_.back().number + 1;
}

void FrameWriter::finish_frame(double time, int number, const std::string& xml) {
  entries_.push_back({time, number, xml});
  run_collectively(comm_, [&] {
    if (rank_ != 0) return;
    replace_file(path(file_name(number)) + ".part", path(file_name(number)));
    write_index();
  });
}

// The index forgets the frames before their files go.
void FrameWriter::drop_frames_from(double time) {
  std::vector<int> dropped;
  while (!entries_.empty() && entries_.back().time >= time) {
    dropped.push_back(entries_.back().number);
    entries_.pop_back();
  }
  if (dropped.empty()) return;
  run_collectively(comm_, [&] {
    if (rank_ != 0) return;
    write_index();
    std::error_code ignored;  // what stays is not in the index
    for (const int number : dropped) std::filesystem::remove(path(file_name(number)), ignored);
  });
}

std::string FrameWriter::file_name(int number) const {
  std::array<char, 16> digits{};
  std::snprintf(digits.data(), digits.size(), "%06d", number);
  return name_ + "_" + digits.data() + ".h5";
}

std::string FrameWriter::path(const std::string& file) const {
  return (std::filesystem::path(directory_) / file).string();
}

// Reads back what write_index wrote: <Grid Name="frame" ...> elements with their time and file.
void FrameWriter::read_index() {
  std::ifstream in(path(name_ + ".xdmf"));
  if (!in) return;
  std::string line;
  Entry entry{};
  while (std::getline(in, line)) {
    line += '\n';
    if (line.find("<Grid Name=\"frame\"") != std::string::npos) {
      entry = Entry{.time = 0, .number = -1, .xml = ""};
    }
    entry.xml += line;
    std::size_t at = line.find("<Time Value=\"");
    if (at != std::string::npos) entry.time = std::stod(line.substr(at + 13));
    at = line.find(">" + name_ + "_");
    if (at != std::string::npos) entry.number = std::stoi(line.substr(at + name_.size() + 2));
    if (line == "      </Grid>\n") {
      if (entry.number < 0)
        throw UserError("cannot continue '" + path(name_ + ".xdmf") +
                        "': a "
                        "frame in it names no file; remove it to start anew");
      entries_.push_back(entry);
    }
  }
}

void FrameWriter::write_index() const {
  const std::string index = path(name_ + ".xdmf");
  std::ofstream out(index + ".part");
  out << "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<Xdmf Version=\"3.0\">\n  <Domain>\n"
      << "    <Grid Name=\"" << name_
      << "\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
  for (const Entry& entry : entries_) out << entry.xml;
  out << "    </Grid>\n  </Domain>\n</Xdmf>\n";
  out.close();
  if (!out) throw UserError("cannot write '" + index + ".part'; is the disk full?");
  replace_file(index + ".part", index);
}

}  // namespace gasgrain
