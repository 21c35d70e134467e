// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "fleet.hpp"

#include "fleet_results.hpp"
#include "manifest.hpp"
#include "text_file.hpp"

#include <thermopower/io/output_files.hpp>

#include <fcntl.h>
#include <spawn.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <deque>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <system_error>
#include <thread>
#include <utility>

extern char** environ;

namespace fs = std::filesystem;
namespace io = thermopower::io;

namespace {

using Clock = std::chrono::steady_clock;

/// A log under work.
struct Task {
  const ManifestLog* log = nullptr;
  std::uintmax_t size = 0;
  unsigned killed = 0;  ///< how often its worker died here
  int lock = -1;        ///< held while its worker runs
  Clock::time_point began;
};

/// What several processes share a fleet by. Whoever holds a log's lock works on it. The system takes the lock from a
/// process that dies, so that nothing of it is in the others' way.
class Fleet {
public:
  Fleet(const FleetArguments& arguments, const std::vector<ManifestLog>& logs)
      : arguments_(arguments),
        logs_(logs),
        out_(arguments.out),
        home_(fs::path(arguments.manifest).parent_path()) {}

  int run() {
    std::error_code error;
    fs::create_directories(out_ / "reports", error);
    if (error) throw io::OutputError(out_.string() + ": cannot be made: " + error.message());
    program_ = fs::read_symlink("/proc/self/exe");
    mark_start();
    tasks_.resize(logs_.size());
    for (std::size_t i = 0; i < logs_.size(); ++i) {
      Task& task = tasks_[i];
      task.log = &logs_[i];
      if (is_done(logs_[i])) {
        ++kept_;
        continue;
      }
      task.size = fs::file_size(home_ / logs_[i].cell("log"), error);
      if (error) task.size = 0;
      waiting_.push_back(&task);
      to_do_ += weight(task);
    }
    std::stable_sort(waiting_.begin(), waiting_.end(),
                     [](const Task* a, const Task* b) { return a->size > b->size; });
    workers_ =
        arguments_.workers != 0 ? arguments_.workers : std::max(1u, std::thread::hardware_concurrency());
    start_ = Clock::now();
    while (!waiting_.empty() || !running_.empty()) {
      const bool found = fill();
      if (!running_.empty()) {
        wait_for_one();
      } else if (!found && !waiting_.empty()) {
        // Others work on all that is left. Should one of them die, its log is free again.
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
      }
      tell_progress();
    }
    if (told_) std::fprintf(stderr, "\r\033[K");
    tell_cost();
    return finish();
  }

private:
  fs::path file_of(const ManifestLog& log, const char* ending) const {
    return out_ / "reports" / (log.id + ending);
  }
  bool is_done(const ManifestLog& log) const {
    std::error_code error;
    return fs::exists(file_of(log, ".json"), error) &&
           (!arguments_.pages || fs::exists(file_of(log, ".html"), error));
  }
  // What failed before this command began is tried again; what failed since, here or elsewhere, is not.
  bool has_failed(const ManifestLog& log) const {
    std::error_code error;
    const auto when = fs::last_write_time(file_of(log, ".failed"), error);
    return !error && when >= begun_;
  }
  // The file system's own clock, which is what the times of its files are by.
  void mark_start() {
    const fs::path mark = out_ / "reports" / ("start." + std::to_string(getpid()));
    std::ofstream(mark).put(' ');
    std::error_code error;
    begun_ = fs::last_write_time(mark, error);
    fs::remove(mark, error);
  }
  // What a log costs, roughly: each takes a while, however short it is.
  static double weight(const Task& task) { return static_cast<double>(task.size) + 1e5; }

  /// Starts as many as there is room for. @return whether anything was started or turned out to be done
  bool fill() {
    bool found = false;
    std::deque<Task*> held;  // by others
    while (!waiting_.empty() && running_.size() < workers_) {
      Task& task = *waiting_.front();
      waiting_.pop_front();
      if (is_done(*task.log) || has_failed(*task.log)) {
        found = true;
        ended(task);
        continue;
      }
      if (!lock(task)) {
        held.push_back(&task);
        continue;
      }
      found = true;
      // Another process may have ended it between the look and the lock.
      if (is_done(*task.log) || has_failed(*task.log)) {
        unlock(task);
        ended(task);
        continue;
      }
      start(task);
    }
    waiting_.insert(waiting_.end(), held.begin(), held.end());
    return found;
  }

  bool lock(Task& task) const {
    const fs::path path = file_of(*task.log, ".lock");
    // The worker inherits it: where this process is killed and the worker lives on, the log stays taken.
    task.lock = open(path.c_str(), O_RDWR | O_CREAT, 0644);
    if (task.lock < 0) throw io::OutputError(path.string() + ": cannot be written: " + std::strerror(errno));
    if (flock(task.lock, LOCK_EX | LOCK_NB) == 0) return true;
    close(task.lock);
    task.lock = -1;
    return false;
  }

  void unlock(Task& task) const {
    unlink(file_of(*task.log, ".lock").c_str());
    close(task.lock);
    task.lock = -1;
  }

  void start(Task& task) {
    const ManifestLog& log = *task.log;
    std::vector<std::string> words = {program_.string(), "diagnose",
                                      "--threads",       "1",
                                      "--model",         (home_ / log.cell("model")).string(),
                                      "--recording",     (home_ / log.cell("log")).string(),
                                      "--report",        file_of(log, ".json").string()};
    if (arguments_.pages) words.insert(words.end(), {"--html", file_of(log, ".html").string()});
    const auto add = [&](const char* column, const char* option) {
      if (log.cell(column).empty()) return;
      words.push_back(option);
      words.push_back((home_ / log.cell(column)).string());
    };
    add("heldout", "--heldout");
    add("map", "--map");
    words.insert(words.end(), arguments_.options.begin(), arguments_.options.end());
    std::vector<char*> values;
    for (std::string& word : words) values.push_back(word.data());
    values.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, file_of(log, ".err").c_str(),
                                     O_WRONLY | O_CREAT | O_TRUNC, 0644);
    // Of the locks only its own: a worker that outlives its parent must not hold another log.
    for (const auto& [other, running] : running_) posix_spawn_file_actions_addclose(&actions, running->lock);
    pid_t child = 0;
    task.began = Clock::now();
    const int fault = posix_spawn(&child, program_.c_str(), &actions, nullptr, values.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (fault != 0) throw io::OutputError(std::string("a worker cannot be started: ") + std::strerror(fault));
    running_[child] = &task;
  }

  void wait_for_one() {
    int status = 0;
    const pid_t child = waitpid(-1, &status, 0);
    if (child < 0) {
      if (errno == EINTR) return;
      throw io::OutputError(std::string("workers cannot be waited for: ") + std::strerror(errno));
    }
    const auto found = running_.find(child);
    if (found == running_.end()) return;
    Task& task = *found->second;
    running_.erase(found);
    busy_ += std::chrono::duration<double>(Clock::now() - task.began).count();
    const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    const bool done = (code == 0 || code == 4) && is_done(*task.log);
    ++diagnosed_;
    if (!done && code < 0 && task.killed++ == 0) {
      unlock(task);
      waiting_.push_front(&task);  // it costs this log a second try, and no other anything
      return;
    }
    const fs::path errors = file_of(*task.log, ".err"), failed = file_of(*task.log, ".failed");
    std::error_code error;
    if (done) {
      fs::remove(failed, error);
      ++new_;
    } else {
      std::string fault = code < 0 ? "its worker was killed twice" : read_text(errors);
      while (!fault.empty() && fault.back() == '\n') fault.pop_back();
      io::OutputFiles outputs;
      outputs.put(failed.string(), fault + "\n");
      outputs.commit();
    }
    fs::remove(errors, error);
    unlock(task);
    ended(task);
  }

  void ended(const Task& task) {
    done_ += weight(task);
    ++ended_;
  }

  void tell_progress() {
    const double seconds = std::chrono::duration<double>(Clock::now() - start_).count();
    if (seconds < 1.0 || isatty(STDERR_FILENO) == 0 || done_ <= 0.0) return;
    told_ = true;
    std::fprintf(stderr, "\r\033[K%zu of %zu logs, %.0f s left", kept_ + ended_, logs_.size(),
                 seconds * std::max(0.0, to_do_ - done_) / done_);
  }

  /// What the hand-out costs: time in which workers might have run and did not.
  void tell_cost() const {
    const double seconds = std::chrono::duration<double>(Clock::now() - start_).count();
    if (diagnosed_ == 0) return;
    std::printf(
        "%zu diagnoses in %.2f s with %u at a time: %.2f ms of work each, workers busy %.1f %%, %.2f ms a log "
        "lost between them\n",
        diagnosed_, seconds, workers_, 1e3 * busy_ / static_cast<double>(diagnosed_),
        100.0 * busy_ / (seconds * workers_),
        1e3 * std::max(0.0, seconds * workers_ - busy_) / static_cast<double>(diagnosed_));
  }

  // What workers left that were killed, or whose fleet was.
  void remove_all_remains() const {
    std::error_code error;
    std::vector<fs::path> remains;
    std::set<std::string> ids;
    for (const ManifestLog& log : logs_) ids.insert(log.id);
    for (const auto& entry : fs::directory_iterator(out_ / "reports", error)) {
      const std::string name = entry.path().filename().string();
      for (const char* ending : {".err", ".lock", ".json.", ".html.", ".failed."}) {
        const std::size_t end = name.rfind(ending);
        if (end != std::string::npos && ids.count(name.substr(0, end)) != 0) remains.push_back(entry.path());
      }
    }
    for (const fs::path& path : remains) fs::remove(path, error);
  }

  // What is written is made of the reports alone: it does not depend on who wrote them, nor in which order.
  int finish() {
    std::vector<FleetLog> all;
    std::size_t without = 0;
    for (const ManifestLog& log : logs_) {
      FleetLog one;
      one.manifest = &log;
      if (is_done(log)) {
        one.report = file_of(log, ".json").string();
        one.page = arguments_.pages ? "reports/" + log.id + ".html" : std::string();
      } else {
        one.fault = read_text(file_of(log, ".failed"));
        while (!one.fault.empty() && one.fault.back() == '\n') one.fault.pop_back();
        ++without;
      }
      all.push_back(std::move(one));
    }
    const fs::path gate = out_ / ".results.lock";
    const int lock = open(gate.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
    if (lock < 0) throw io::OutputError(gate.string() + ": cannot be written: " + std::strerror(errno));
    if (flock(lock, LOCK_EX | LOCK_NB) != 0) {
      // Waited for, as what starts many of these may end them all when the first one is done.
      while (flock(lock, LOCK_EX) != 0 && errno == EINTR) {
      }
      std::error_code error;
      const auto when = fs::last_write_time(out_ / "summary.txt", error);
      if (!error && when >= begun_) {
        close(lock);
        std::printf("%zu logs: another process of this fleet wrote the results\n", logs_.size());
        return without == 0 ? 0 : 3;
      }
    }
    remove_all_remains();
    without = write_fleet_results(all, out_.string());
    unlink(gate.c_str());
    close(lock);
    std::printf("%zu logs: %zu reports were there, %zu are new, %zu have none\n", logs_.size(),
                logs_.size() - new_ - without, new_, without);
    for (const FleetLog& one : all)
      if (!one.fault.empty())
        std::fprintf(stderr, "%s:%zu: %s\n", arguments_.manifest.c_str(), one.manifest->line,
                     one.fault.c_str());
    std::fputs(summary_of_results().c_str(), stdout);
    return without == 0 ? 0 : 3;
  }

  std::string summary_of_results() const { return read_text(out_ / "summary.txt"); }

  const FleetArguments& arguments_;
  const std::vector<ManifestLog>& logs_;
  fs::path out_, home_, program_;
  std::vector<Task> tasks_;
  std::deque<Task*> waiting_;
  std::map<pid_t, Task*> running_;
  unsigned workers_ = 1;
  std::size_t kept_ = 0, new_ = 0, ended_ = 0, diagnosed_ = 0;
  double to_do_ = 0.0, done_ = 0.0, busy_ = 0.0;
  Clock::time_point start_;
  fs::file_time_type begun_;
  bool told_ = false;
};

}  // namespace

int run_fleet(const FleetArguments& arguments) {
  const std::vector<ManifestLog> logs = read_manifest(arguments.manifest, arguments.options);
  return Fleet(arguments, logs).run();
}
