// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "fleet.hpp"

#include <thermopower/io/input_error.hpp>
#include <thermopower/io/output_files.hpp>

#include <nlohmann/json.hpp>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <system_error>
#include <thread>
#include <utility>

extern char** environ;

namespace fs = std::filesystem;
namespace io = thermopower::io;

namespace {

/// One row of the manifest.
struct Log {
  std::map<std::string, std::string> cells;
  std::size_t line = 0;
  std::string id;  ///< of its files, from what is diagnosed and how
  std::uintmax_t size = 0;
  bool done = false;
  unsigned killed = 0;  ///< how often its worker died
  std::string fault;    ///< why there is no report
  const std::string& cell(const std::string& name) const {
    static const std::string none;
    const auto found = cells.find(name);
    return found == cells.end() ? none : found->second;
  }
};

std::string read_text(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

// One line of the manifest; a cell may be in quotes.
std::vector<std::string> cells_of(const std::string& line, const std::string& where) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (quoted) {
      if (c != '"') cells.back() += c;
      else if (i + 1 < line.size() && line[i + 1] == '"') cells.back() += line[++i];
      else quoted = false;
    } else if (c == '"' && cells.back().empty()) {
      quoted = true;
    } else if (c == ',') {
      cells.emplace_back();
    } else {
      cells.back() += c;
    }
  }
  if (quoted)
    throw io::InputError(where + "a quote that is never closed; expected a closing '\"' in the same line");
  return cells;
}

std::string hash_of(const std::string& text) {
  std::uint64_t hash = 14695981039346656037ull;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ull;
  char out[17];
  std::snprintf(out, sizeof out, "%016llx", static_cast<unsigned long long>(hash));
  return out;
}

// Letters and digits of the log's name, and what tells it from every other task: another model, or the same one
// changed, is another task.
std::string id_of(const Log& log, const std::vector<std::string>& options, const fs::path& home) {
  std::string key, name;
  for (const auto& [column, value] : log.cells) key += column + '\0' + value + '\0';
  for (const std::string& option : options) key += option + '\0';
  for (const char* file : {"model", "map"})
    if (!log.cell(file).empty()) key += read_text(home / log.cell(file)) + '\0';
  for (const char c : fs::path(log.cell("log")).stem().string()) {
    const bool plain =
        (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
    if (name.size() < 60) name += plain ? c : '_';
  }
  return name + "-" + hash_of(key).substr(0, 10);
}

std::vector<Log> read_manifest(const FleetArguments& arguments) {
  const std::string& path = arguments.manifest;
  std::ifstream file(path, std::ios::binary);
  std::error_code status;
  if (!file || fs::is_directory(path, status))
    throw io::InputError(path + ": cannot be read; expected a manifest (CSV)");
  std::vector<std::string> header;
  std::vector<Log> logs;
  std::map<std::string, std::size_t> lines;
  std::size_t number = 0;
  for (std::string line; std::getline(file, line);) {
    const std::string where = path + ":" + std::to_string(++number) + ": ";
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.empty() || line[0] == '#') continue;
    std::vector<std::string> cells = cells_of(line, where);
    if (header.empty()) {
      for (const std::string& name : cells)
        if (name != "log" && name != "model" && name != "unit" && name != "heldout" && name != "map")
          throw io::InputError(where + "column " + io::excerpt(name) +
                               "; expected log, model, unit, heldout or map");
      for (const char* needed : {"log", "model"})
        if (std::count(cells.begin(), cells.end(), needed) != 1)
          throw io::InputError(where + "expected one column '" + needed + "' in the header row");
      header = std::move(cells);
      continue;
    }
    if (cells.size() != header.size())
      throw io::InputError(where + std::to_string(cells.size()) + " cells; expected " +
                           std::to_string(header.size()) + " as in the header row");
    Log log;
    log.line = number;
    for (std::size_t i = 0; i < cells.size(); ++i) log.cells[header[i]] = cells[i];
    for (const char* needed : {"log", "model"})
      if (log.cell(needed).empty())
        throw io::InputError(where + "column '" + needed + "': empty; expected a path");
    log.id = id_of(log, arguments.options, fs::path(path).parent_path());
    const auto [other, is_new] = lines.emplace(log.id, number);
    if (!is_new) throw io::InputError(where + "the same log as in line " + std::to_string(other->second));
    logs.push_back(std::move(log));
  }
  if (logs.empty())
    throw io::InputError(path + ": no log in it; expected a header row with 'log' and 'model', and rows");
  return logs;
}

class Fleet {
public:
  Fleet(const FleetArguments& arguments, std::vector<Log> logs)
      : arguments_(arguments),
        logs_(std::move(logs)),
        out_(arguments.out),
        home_(fs::path(arguments.manifest).parent_path()) {}

  int run() {
    std::error_code error;
    fs::create_directories(out_ / "reports", error);
    if (error) throw io::OutputError(out_.string() + ": cannot be made: " + error.message());
    program_ = fs::read_symlink("/proc/self/exe");
    for (Log& log : logs_) {
      log.size = fs::file_size(home_ / log.cell("log"), error);
      if (error) log.size = 0;
      log.done = fs::exists(report(log));
      if (!log.done) waiting_.push_back(&log);
    }
    std::stable_sort(waiting_.begin(), waiting_.end(),
                     [](const Log* a, const Log* b) { return a->size > b->size; });
    kept_ = logs_.size() - waiting_.size();
    for (const Log* log : waiting_) to_do_ += weight(*log);
    const unsigned workers =
        arguments_.workers != 0 ? arguments_.workers : std::max(1u, std::thread::hardware_concurrency());
    start_ = std::chrono::steady_clock::now();
    while (next_ < waiting_.size() || !running_.empty()) {
      while (next_ < waiting_.size() && running_.size() < workers) start(*waiting_[next_++]);
      wait_for_one();
      tell_progress();
    }
    if (told_) std::fprintf(stderr, "\r\033[K");
    return finish();
  }

private:
  fs::path report(const Log& log) const { return out_ / "reports" / (log.id + ".json"); }
  fs::path errors(const Log& log) const { return out_ / "reports" / (log.id + ".err"); }
  // What a log costs, roughly: each takes a while, however short it is.
  static double weight(const Log& log) { return static_cast<double>(log.size) + 1e5; }

  void start(Log& log) {
    std::vector<std::string> words = {program_.string(), "diagnose",
                                      "--threads",       "1",
                                      "--model",         (home_ / log.cell("model")).string(),
                                      "--recording",     (home_ / log.cell("log")).string(),
                                      "--report",        report(log).string()};
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
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, errors(log).c_str(),
                                     O_WRONLY | O_CREAT | O_TRUNC, 0644);
    pid_t child = 0;
    const int fault = posix_spawn(&child, program_.c_str(), &actions, nullptr, values.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (fault != 0) throw io::OutputError(std::string("a worker cannot be started: ") + std::strerror(fault));
    running_[child] = &log;
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
    Log& log = *found->second;
    running_.erase(found);
    const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    if ((code == 0 || code == 4) && fs::exists(report(log))) {
      log.done = true;
    } else if (code < 0 && log.killed++ == 0) {
      waiting_.push_back(&log);  // it costs this log a second try, and no other anything
      return;
    } else {
      log.fault = code < 0 ? "its worker was killed twice" : read_text(errors(log));
      while (!log.fault.empty() && log.fault.back() == '\n') log.fault.pop_back();
    }
    done_ += weight(log);
    ++ended_;
  }

  void tell_progress() {
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    if (seconds < 1.0 || isatty(STDERR_FILENO) == 0 || done_ <= 0.0) return;
    told_ = true;
    std::fprintf(stderr, "\r\033[K%zu of %zu logs, %.0f s left", kept_ + ended_, logs_.size(),
                 seconds * std::max(0.0, to_do_ - done_) / done_);
  }

  static std::string quoted(const std::string& text) {
    if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
    std::string out = "\"";
    for (const char c : text) {
      if (c == '"') out += '"';
      out += c == '\n' || c == '\r' ? ' ' : c;
    }
    return out + "\"";
  }

  // What workers left that are done, or that were killed, or whose fleet was.
  void remove_all_remains() const {
    std::error_code error;
    std::vector<fs::path> remains;
    std::set<std::string> ids;
    for (const Log& log : logs_) ids.insert(log.id);
    for (const auto& entry : fs::directory_iterator(out_ / "reports", error)) {
      const std::string name = entry.path().filename().string();
      const std::size_t end = std::min(name.rfind(".err"), name.find(".json."));
      if (end != std::string::npos && ids.count(name.substr(0, end)) != 0) remains.push_back(entry.path());
    }
    for (const fs::path& path : remains) fs::remove(path, error);
  }

  // The table is made of the reports alone: it does not depend on who wrote them, nor in which order.
  int finish() {
    remove_all_remains();
    std::string table = "line,unit,log,verdict,cause,probability,report,fault\n";
    std::map<std::string, std::size_t> verdicts, causes;
    std::size_t without = 0;
    for (Log& log : logs_) {
      std::string verdict, cause, probability;
      if (log.done) {
        const nlohmann::json told = nlohmann::json::parse(read_text(report(log)), nullptr, false);
        if (!told.is_object() || !told.contains("verdict") || !told["verdict"].is_string()) {
          log.fault = report(log).string() + " is no report; remove it and run again";
        } else {
          verdict = told["verdict"];
          ++verdicts[verdict];
          for (const auto& one : told.value("cause", nlohmann::json::array())) {
            const std::string effect = one.value("effect", std::string());
            cause += (cause.empty() ? "" : "+") + effect;
            if (probability.empty() && one.contains("probability")) probability = one["probability"].dump();
            ++causes[effect];
          }
        }
      }
      without += log.fault.empty() ? 0 : 1;
      table += std::to_string(log.line) + "," + quoted(log.cell("unit")) + "," + quoted(log.cell("log")) +
               "," + verdict + "," + quoted(cause) + "," + probability + "," +
               (verdict.empty() ? "" : "reports/" + log.id + ".json") + "," + quoted(log.fault) + "\n";
    }
    io::OutputFiles outputs;
    outputs.expect((out_ / "logs.csv").string());
    outputs.put((out_ / "logs.csv").string(), table);
    outputs.commit();
    std::printf("%zu logs: %zu reports were there, %zu are new, %zu have none\n", logs_.size(), kept_,
                logs_.size() - kept_ - without, without);
    for (const auto& [verdict, count] : verdicts) std::printf("  %-14s %zu\n", verdict.c_str(), count);
    if (!causes.empty()) std::printf("causes named:\n");
    std::vector<std::pair<std::size_t, std::string>> often;
    for (const auto& [cause, count] : causes) often.emplace_back(count, cause);
    std::stable_sort(often.begin(), often.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    for (const auto& [count, cause] : often) std::printf("  %-28s %zu\n", cause.c_str(), count);
    for (const Log& log : logs_)
      if (!log.fault.empty())
        std::fprintf(stderr, "%s:%zu: %s\n", arguments_.manifest.c_str(), log.line, log.fault.c_str());
    return without == 0 ? 0 : 3;
  }

  const FleetArguments& arguments_;
  std::vector<Log> logs_;
  fs::path out_, home_, program_;
  std::vector<Log*> waiting_;
  std::map<pid_t, Log*> running_;
  std::size_t next_ = 0, kept_ = 0, ended_ = 0;
  double to_do_ = 0.0, done_ = 0.0;
  std::chrono::steady_clock::time_point start_;
  bool told_ = false;
};

}  // namespace

int run_fleet(const FleetArguments& arguments) { return Fleet(arguments, read_manifest(arguments)).run(); }
