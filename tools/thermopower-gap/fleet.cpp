// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "fleet.hpp"

#include "fleet_results.hpp"
#include "manifest.hpp"
#include "text_file.hpp"
#include "worker_pool.hpp"

#include <thermopower/io/output_files.hpp>

#include <fcntl.h>
#include <sys/file.h>
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
#include <set>
#include <system_error>
#include <thread>
#include <utility>

namespace fs = std::filesystem;
namespace io = thermopower::io;

namespace {

using Clock = std::chrono::steady_clock;

/// What a worker says of a log.
constexpr char has_result = 'r', is_elsewhere = 'e', is_settled = 's';

/// A log that has no report yet.
struct Task {
  const ManifestLog* log = nullptr;
  std::uintmax_t size = 0;
  unsigned killed = 0;  ///< how often its worker died here
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
      waiting_.push_back(i);
      to_do_ += weight(task);
    }
    std::stable_sort(waiting_.begin(), waiting_.end(),
                     [this](std::size_t a, std::size_t b) { return tasks_[a].size > tasks_[b].size; });
    workers_ =
        arguments_.workers != 0 ? arguments_.workers : std::max(1u, std::thread::hardware_concurrency());
    start_ = Clock::now();
    try {
      hand_out();
    } catch (const std::system_error& fault) {
      throw io::OutputError(fault.what());
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
  bool is_over(const ManifestLog& log) const { return is_done(log) || has_failed(log); }
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

  void hand_out() {
    WorkerPool pool(workers_, [this](std::size_t task) { return work(task); });
    std::vector<std::size_t> elsewhere;  // others have them in hand
    while (!waiting_.empty() || !elsewhere.empty() || pool.busy() > 0) {
      while (!waiting_.empty() && pool.has_room()) {
        const std::size_t next = waiting_.front();
        waiting_.pop_front();
        if (is_over(*tasks_[next].log)) ended(next);
        else pool.give(next);
      }
      if (pool.busy() == 0 && elsewhere.empty()) continue;
      // Should one of the others die, its log is free again.
      const bool look_again = !elsewhere.empty() && pool.has_room();
      if (arguments_.stop && arguments_.stop()) throw FleetStopped();
      if (const auto answer = pool.wait(look_again ? 50 : arguments_.stop ? 100 : -1)) {
        take(*answer, elsewhere);
      } else {
        waiting_.insert(waiting_.end(), elsewhere.begin(), elsewhere.end());
        elsewhere.clear();
      }
      tell_progress();
    }
  }

  void take(const WorkerPool::Answer& answer, std::vector<std::size_t>& elsewhere) {
    Task& task = tasks_[answer.task];
    if (answer.said == is_elsewhere) {
      elsewhere.push_back(answer.task);
      return;
    }
    busy_ += answer.seconds;
    if (answer.said == is_settled) {
      ended(answer.task);
      return;
    }
    ++diagnosed_;
    if (!answer.said) {
      if (task.killed++ == 0) {
        waiting_.push_front(answer.task);  // it costs this log a second try, and no other anything
        return;
      }
      const int lock = locked(*task.log);
      if (lock < 0) {
        elsewhere.push_back(answer.task);
        return;
      }
      if (!is_over(*task.log)) put_failure(*task.log, "its worker was killed twice");
      unlock(*task.log, lock);
    }
    if (is_done(*task.log)) ++new_;
    ended(answer.task);
  }

  /// Takes a log's lock. @return it; -1 where another holds it
  int locked(const ManifestLog& log) const {
    const fs::path path = file_of(log, ".lock");
    const int lock = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
    if (lock < 0) throw io::OutputError(path.string() + ": cannot be written: " + std::strerror(errno));
    if (flock(lock, LOCK_EX | LOCK_NB) == 0) return lock;
    close(lock);
    return -1;
  }

  void unlock(const ManifestLog& log, int lock) const {
    unlink(file_of(log, ".lock").c_str());
    close(lock);
  }

  void put_failure(const ManifestLog& log, std::string fault) const {
    while (!fault.empty() && fault.back() == '\n') fault.pop_back();
    io::OutputFiles outputs;
    outputs.put(file_of(log, ".failed").string(), fault + "\n");
    outputs.commit();
  }

  /// In a worker: diagnoses a log, unless others do or did.
  char work(std::size_t which) const {
    const ManifestLog& log = logs_[which];
    const int lock = locked(log);
    if (lock < 0) return is_elsewhere;
    // Another process may have ended it between the look and the lock.
    const bool over = is_over(log);
    if (!over) diagnose(log);
    unlock(log, lock);
    return over ? is_settled : has_result;
  }

  void diagnose(const ManifestLog& log) const {
    const auto path = [&](const char* column) {
      return log.cell(column).empty() ? std::string() : (home_ / log.cell(column)).string();
    };
    FleetDiagnosis asked;
    asked.model = path("model");
    asked.recording = path("log");
    asked.held_out = path("heldout");
    asked.map = path("map");
    asked.report = file_of(log, ".json").string();
    if (arguments_.pages) asked.page = file_of(log, ".html").string();
    std::string fault = arguments_.diagnose(asked);
    const std::string program = "thermopower-gap: ";  // the place in the table is put before it instead
    if (fault.compare(0, program.size(), program) == 0) fault.erase(0, program.size());
    std::error_code error;
    if (fault.empty() && is_done(log)) fs::remove(file_of(log, ".failed"), error);
    else put_failure(log, fault.empty() ? "its report is not there any more" : fault);
  }

  void ended(std::size_t task) {
    done_ += weight(tasks_[task]);
    ++ended_;
  }

  void tell_progress() {
    const double seconds = std::chrono::duration<double>(Clock::now() - start_).count();
    if (arguments_.quiet || seconds < 1.0 || isatty(STDERR_FILENO) == 0 || done_ <= 0.0) return;
    told_ = true;
    std::fprintf(stderr, "\r\033[K%zu of %zu logs, %.0f s left", kept_ + ended_, logs_.size(),
                 seconds * std::max(0.0, to_do_ - done_) / done_);
  }

  /// What the hand-out costs: time in which workers might have run and did not.
  void tell_cost() const {
    const double seconds = std::chrono::duration<double>(Clock::now() - start_).count();
    if (diagnosed_ == 0 || arguments_.quiet) return;
    std::printf("%zu %s in %.2f s with %u at a time: %.2f ms of work each, workers busy %.1f %%\n",
                diagnosed_, diagnosed_ == 1 ? "diagnosis" : "diagnoses", seconds, workers_,
                1e3 * busy_ / static_cast<double>(diagnosed_), 100.0 * busy_ / (seconds * workers_));
  }

  // What workers left that were killed, or whose fleet was.
  void remove_all_remains() const {
    std::error_code error;
    std::vector<fs::path> remains;
    std::set<std::string> ids;
    for (const ManifestLog& log : logs_) ids.insert(log.id);
    for (const auto& entry : fs::directory_iterator(out_ / "reports", error)) {
      const std::string name = entry.path().filename().string();
      for (const char* ending : {".lock", ".json.", ".html.", ".failed."}) {
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
        if (!arguments_.quiet)
          std::printf("%zu logs: another process of this fleet wrote the results\n", logs_.size());
        return without == 0 ? 0 : 3;
      }
    }
    remove_all_remains();
    without = write_fleet_results(all, out_.string());
    unlink(gate.c_str());
    close(lock);
    if (arguments_.quiet) return without == 0 ? 0 : 3;
    std::printf("%zu %s: %zu reports were there, %zu are new, %zu have none\n", logs_.size(),
                logs_.size() == 1 ? "log" : "logs", logs_.size() - new_ - without, new_, without);
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
  fs::path out_, home_;
  std::vector<Task> tasks_;          // of every log
  std::deque<std::size_t> waiting_;  // in the order in which they are handed out
  unsigned workers_ = 1;
  std::size_t kept_ = 0, new_ = 0, ended_ = 0, diagnosed_ = 0;
  double to_do_ = 0.0, done_ = 0.0, busy_ = 0.0;
  Clock::time_point start_;
  fs::file_time_type begun_;
  bool told_ = false;
};

}  // namespace

std::vector<std::string> options_of_fleet(const Arguments& each, bool horizon) {
  std::vector<std::string> options;
  for (const std::string& one : each.columns) options.insert(options.end(), {"--column", one});
  for (const std::string& one : each.without) options.insert(options.end(), {"--without", one});
  if (horizon) {
    // No two numbers have the same text.
    std::string text = std::to_string(each.horizon_s);
    char exact[40];
    std::snprintf(exact, sizeof exact, "%.17g", each.horizon_s);
    if (std::stod(text) != each.horizon_s) text = exact;
    options.insert(options.end(), {"--horizon", text});
  }
  return options;
}

std::string diagnose_of_fleet(const FleetDiagnosis& one, const Arguments& asked) {
  Arguments arguments = asked;
  arguments.model = one.model;
  arguments.recordings = {one.recording};
  if (!one.held_out.empty()) arguments.held_out = {one.held_out};
  if (!one.map.empty()) arguments.maps = {one.map};
  arguments.report = one.report;
  arguments.html = one.page;
  arguments.threads = 1;
  arguments.of_fleet = true;
  std::string fault;
  guarded([&] { return diagnose(arguments); }, fault);
  return fault;
}

int run_fleet(const FleetArguments& arguments) {
  const std::vector<ManifestLog> logs = read_manifest(arguments.manifest, arguments.options);
  return Fleet(arguments, logs).run();
}
