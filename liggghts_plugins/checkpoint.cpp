#include "liggghts_plugins/checkpoint.hpp"

#include <comm.h>
#include <lammps.h>
#include <mpi.h>
#include <run.h>
#include <signal_handling.h>
#include <update.h>
#include <write_restart.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <map>
#include <optional>
#include <vector>

#include "coupling/files/collective_error.hpp"
#include "coupling/shared/complete_file.hpp"
#include "coupling/shared/error.hpp"
#include "coupling/shared/step_files.hpp"

namespace gasgrain::plugins {

namespace {

using LAMMPS_NS::bigint;
using LAMMPS_NS::LAMMPS;
namespace signals = LAMMPS_NS::SignalHandler;
namespace files = std::filesystem;

struct Checkpoints {
  bigint every = 0;  // steps; 0: none
  std::string directory;
  bool being_written = false;
  bool run_goes_on = false;
};

Checkpoints& checkpoints(const LAMMPS& lmp) {
  static std::map<const LAMMPS*, Checkpoints> all;
  return all[&lmp];
}

std::optional<bigint> whole_number(const std::string& word) {
  bigint value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return value;
}

void print(const LAMMPS& lmp, const std::string& line) {
  if (lmp.comm->me != 0) return;
  for (FILE* file : {lmp.screen, lmp.logfile})
    if (file) std::fprintf(file, "%s\n", line.c_str());
}

// Whether any rank was asked to end; then all of them are.
bool quit_requested(const LAMMPS& lmp) {
  int quit = signals::request_quit ? 1 : 0;
  MPI_Allreduce(MPI_IN_PLACE, &quit, 1, MPI_INT, MPI_MAX, lmp.world);
  signals::request_quit = quit != 0;
  return quit != 0;
}

// A script's `run`.
struct RunRequest {
  bigint first, last;  // steps
  bigint begin, end;   // of the ramps of styles: keywords start and stop
  std::string post = "yes";
};

[[noreturn]] void fail(const std::string& message) {
  throw UserError("gasgrain_checkpoint: " + message);
}

// The whole number that `where` needs.
bigint step_of(const std::string& word, const std::string& where) {
  const std::optional<bigint> number = whole_number(word.c_str());
  if (!number) fail(where + " is '" + word + "', but must be a whole number of steps");
  return *number;
}

RunRequest read_request(const LAMMPS& lmp, int count, char** words) {
  const bigint now = lmp.update->ntimestep;
  if (count == 0) fail("`run` needs a number of steps");
  const bigint steps = step_of(words[0], "`run`");
  RunRequest request{now, now + steps, now, 0, "yes"};
  std::optional<bigint> begin, end;
  for (int n = 1; n < count; ++n) {
    const std::string word = words[n];
    if (word == "upto") {
      request.last = steps;
      continue;
    }
    if (word != "start" && word != "stop" && word != "post")
      fail("`run` with the keyword " + word +
           " cannot be divided; remove it or switch checkpoints off");
    if (n + 1 == count) fail("`run` keyword " + word + " needs a value");
    const std::string value = words[++n];
    if (word == "post")
      request.post = value;
    else
      (word == "start" ? begin : end) = step_of(value, "`run` keyword " + word);
  }
  if (request.last < request.first)
    fail("`run " + std::string(words[0]) + " upto` ends before the present step " +
         std::to_string(now) + "; give that or a later one");
  request.begin = begin.value_or(request.first);
  request.end = end.value_or(request.last);
  return request;
}

void run_part(LAMMPS& lmp, const RunRequest& request, bigint steps, const std::string& post) {
  std::vector<std::string> words = {std::to_string(steps),
                                    "start",
                                    std::to_string(request.begin),
                                    "stop",
                                    std::to_string(request.end),
                                    "post",
                                    post};
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  LAMMPS_NS::Run(&lmp).command(static_cast<int>(arguments.size()), arguments.data());
}

const StepFileName grains_file{"grains.", ".restart"}, gas_file{"gas.", ".state.h5"};

void make_latest(const files::path& directory, long step) {
  const files::path latest = directory / "latest.restart", fresh = directory / "latest.restart.new";
  std::error_code ignored;  // absent is as good as removed, and has no step
  const std::optional<long> before =
      step_of_file(grains_file, files::read_symlink(latest, ignored).string());
  files::remove(fresh, ignored);
  files::create_symlink(file_of_step(grains_file, step), fresh);
  files::rename(fresh, latest);
  put_on_disk(directory);
  for (const StepFileName& name : {grains_file, gas_file})
    keep_last_two(directory, name, step, before);
}

// Runs `work` on rank 0; what it throws, all ranks throw.
template <class Work>
void on_first_rank(const LAMMPS& lmp, const std::string& what, const Work& work) {
  run_collectively(lmp.world, [&] {
    if (lmp.comm->me != 0) return;
    try {
      work();
    } catch (const std::exception& error) {
      fail("cannot " + what + ": " + error.what());
    }
  });
}

void write_checkpoint(LAMMPS& lmp) {
  Checkpoints& wanted = checkpoints(lmp);
  const files::path directory = wanted.directory;
  const long step = lmp.update->ntimestep;
  const std::string name = file_of_step(grains_file, step);
  const double start = MPI_Wtime();
  on_first_rank(lmp, "make the directory " + wanted.directory,
                [&] { files::create_directories(directory); });
  std::string partial = (directory / (name + ".partial")).string();
  char* argument = partial.data();
  wanted.being_written = true;
  LAMMPS_NS::WriteRestart(&lmp).command(1, &argument);
  wanted.being_written = false;
  on_first_rank(lmp, "complete the checkpoint in " + wanted.directory, [&] {
    complete_file(partial, directory / name);
    make_latest(directory, step);
  });
  char line[160];
  std::snprintf(line, sizeof line, "Checkpoint at step %ld: %s/latest.restart (%.2f s)", step,
                wanted.directory.c_str(), MPI_Wtime() - start);
  print(lmp, line);
}

}  // namespace

void set_checkpoints(LAMMPS* lmp, int argument_count, char** arguments) {
  Checkpoints& wanted = checkpoints(*lmp);
  if (argument_count == 1 && std::strcmp(arguments[0], "off") == 0) {
    wanted = {};
    return;
  }
  if (argument_count != 2) fail("expects a number of steps and a directory, or off");
  const std::optional<bigint> every = whole_number(arguments[0]);
  if (!every || *every <= 0)
    fail(std::string("the number of steps between checkpoints is ") + arguments[0] +
         ", but must be a whole number > 0");
  wanted.every = *every;
  wanted.directory = arguments[1];
}

void run_with_checkpoints(LAMMPS& lmp, int argument_count, char** arguments) {
  Checkpoints& wanted = checkpoints(lmp);
  if (wanted.every == 0) {
    LAMMPS_NS::Run(&lmp).command(argument_count, arguments);
    return;
  }
  const RunRequest request = read_request(lmp, argument_count, arguments);
  const bigint& step = lmp.update->ntimestep;
  do {
    const bigint next = std::min(request.last, (step / wanted.every + 1) * wanted.every);
    wanted.run_goes_on = next < request.last;
    run_part(lmp, request, next - step, wanted.run_goes_on ? "no" : request.post);
    const bool quit = quit_requested(lmp);
    if (request.last > request.first) write_checkpoint(lmp);
    if (quit) {
      print(lmp, "Ended by a signal at step " + std::to_string(step) +
                     "; to go on, begin with `read_restart " + wanted.directory +
                     "/latest.restart`");
      break;
    }
  } while (step < request.last);
  wanted.run_goes_on = false;
}

std::string checkpoint_directory(const LAMMPS& lmp) {
  const Checkpoints& wanted = checkpoints(lmp);
  return wanted.being_written ? wanted.directory : "";
}

bool run_goes_on(const LAMMPS& lmp) {
  return checkpoints(lmp).run_goes_on;
}

}  // namespace gasgrain::plugins
