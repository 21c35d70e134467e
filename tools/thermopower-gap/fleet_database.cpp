// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "fleet_results.hpp"
#include "text_file.hpp"

#include <thermopower/io/output_files.hpp>

#ifdef THERMOPOWER_HAS_SQLITE

#include <sqlite3.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <memory>
#include <optional>

namespace io = thermopower::io;
namespace pool = thermopower::gap::pool;

namespace {

// docs/reference/fleet-database.md describes it, and a test compares both.
constexpr const char* schema = R"sql(
CREATE TABLE fleet (format TEXT NOT NULL, logs INTEGER NOT NULL, structure_differs INTEGER NOT NULL, parameters_differ INTEGER NOT NULL);
CREATE TABLE log (id INTEGER PRIMARY KEY, line INTEGER NOT NULL, log TEXT NOT NULL, model TEXT NOT NULL, unit TEXT, time_days REAL, verdict TEXT, reason TEXT, report TEXT, page TEXT, fault TEXT);
CREATE TABLE cause (log INTEGER NOT NULL REFERENCES log(id), effect TEXT NOT NULL, place INTEGER NOT NULL);
CREATE TABLE explanation (id INTEGER PRIMARY KEY, log INTEGER NOT NULL REFERENCES log(id), effects TEXT NOT NULL, probability REAL, misfit REAL, train_gain REAL, held_out_gain REAL, on_bounds INTEGER NOT NULL);
CREATE TABLE estimate (explanation INTEGER NOT NULL REFERENCES explanation(id), parameter TEXT NOT NULL, value REAL, relative INTEGER NOT NULL, sd REAL, at_bound INTEGER NOT NULL);
CREATE TABLE family (id INTEGER PRIMARY KEY, cause TEXT NOT NULL, share REAL NOT NULL, share_low REAL NOT NULL, share_high REAL NOT NULL, units REAL NOT NULL);
CREATE TABLE spread (family INTEGER NOT NULL REFERENCES family(id), parameter TEXT NOT NULL, mean REAL, relative INTEGER NOT NULL, between_units_sd REAL, between_logs_sd REAL, differs INTEGER NOT NULL, range90_low REAL, range90_high REAL);
CREATE TABLE unit (id INTEGER PRIMARY KEY, unit TEXT NOT NULL, logs INTEGER NOT NULL, family INTEGER REFERENCES family(id), member INTEGER NOT NULL, own_cause TEXT, odd TEXT NOT NULL, furthest TEXT, standard_deviations REAL, p REAL, misfit REAL);
CREATE TABLE unit_parameter (unit INTEGER NOT NULL REFERENCES unit(id), parameter TEXT NOT NULL, value REAL, relative INTEGER NOT NULL, sd REAL, own_value REAL, own_sd REAL);
CREATE TABLE drift (unit INTEGER NOT NULL REFERENCES unit(id), parameter TEXT NOT NULL, kind TEXT NOT NULL, size REAL, relative INTEGER NOT NULL, since_days REAL, until_days REAL, p REAL);
CREATE TABLE weak_effect (effect TEXT NOT NULL, stands INTEGER NOT NULL, units INTEGER NOT NULL, held_out_gain REAL, gain REAL, p REAL);
)sql";

class Database {
public:
  explicit Database(const std::string& path) {
    const int fault = sqlite3_open(path.c_str(), &handle_);
    if (fault != SQLITE_OK) fail("open");
    run("PRAGMA journal_mode=OFF; PRAGMA synchronous=OFF; BEGIN;");
  }
  ~Database() { sqlite3_close(handle_); }
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;

  void run(const std::string& statements) {
    if (sqlite3_exec(handle_, statements.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK)
      fail(statements.c_str());
  }

  sqlite3* handle() const { return handle_; }

  [[noreturn]] void fail(const char* doing) const {
    throw io::OutputError(std::string("fleet.sqlite: ") + sqlite3_errmsg(handle_) + " (" + doing + ")");
  }

private:
  sqlite3* handle_ = nullptr;
};

/// Puts rows into one table.
class Rows {
public:
  Rows(Database& database, const char* table, int columns) : database_(database) {
    std::string text = std::string("INSERT INTO ") + table + " VALUES (";
    for (int i = 0; i < columns; ++i) text += i == 0 ? "?" : ",?";
    if (sqlite3_prepare_v2(database.handle(), (text + ")").c_str(), -1, &statement_, nullptr) != SQLITE_OK)
      database.fail(table);
  }
  ~Rows() { sqlite3_finalize(statement_); }
  Rows(const Rows&) = delete;
  Rows& operator=(const Rows&) = delete;

  Rows& operator<<(const std::string& text) {
    sqlite3_bind_text(statement_, ++at_, text.c_str(), static_cast<int>(text.size()), SQLITE_TRANSIENT);
    return *this;
  }
  Rows& operator<<(const char* text) { return *this << std::string(text); }
  Rows& operator<<(double value) {  // NaN is NULL
    if (std::isfinite(value)) sqlite3_bind_double(statement_, ++at_, value);
    else sqlite3_bind_null(statement_, ++at_);
    return *this;
  }
  Rows& operator<<(std::size_t value) { return whole(static_cast<sqlite3_int64>(value)); }
  Rows& operator<<(bool value) { return whole(value ? 1 : 0); }
  Rows& whole(sqlite3_int64 value) {
    sqlite3_bind_int64(statement_, ++at_, value);
    return *this;
  }
  Rows& text_or_null(const std::string& text) {
    if (!text.empty()) return *this << text;
    sqlite3_bind_null(statement_, ++at_);
    return *this;
  }
  Rows& none() {
    sqlite3_bind_null(statement_, ++at_);
    return *this;
  }
  void end() {
    if (sqlite3_step(statement_) != SQLITE_DONE) database_.fail("insert");
    sqlite3_reset(statement_);
    sqlite3_clear_bindings(statement_);
    at_ = 0;
  }

private:
  Database& database_;
  sqlite3_stmt* statement_ = nullptr;
  int at_ = 0;
};

double root(double variance) {
  return variance >= 0.0 ? std::sqrt(variance) : std::numeric_limits<double>::quiet_NaN();
}

void fill(Database& database, const FleetResults& fleet) {
  const pool::FleetVerdict& verdict = fleet.verdict;
  database.run(schema);
  Rows whole(database, "fleet", 4);
  (whole << "thermopower-fleet/1" << fleet.logs.size() << verdict.structure_differs
         << verdict.parameters_differ)
      .end();
  Rows logs(database, "log", 11), causes(database, "cause", 3), explanations(database, "explanation", 8),
      estimates(database, "estimate", 6);
  std::size_t explanation = 0;
  for (std::size_t i = 0; i < fleet.logs.size(); ++i) {
    const FleetLog& log = fleet.logs[i];
    const pool::LogResult& result = fleet.results[i];
    logs << i + 1 << log.manifest->line << log.manifest->cell("log") << log.manifest->cell("model");
    logs.text_or_null(log.manifest->cell("unit")) << log.manifest->time_days;
    logs.text_or_null(spelt(result.verdict)).text_or_null(result.reason);
    logs.text_or_null(!result.verdict ? std::string() : "reports/" + log.manifest->id + ".json");
    logs.text_or_null(log.page).text_or_null(log.fault);
    logs.end();
    for (std::size_t place = 0; place < fleet.causes[i].size(); ++place)
      (causes << i + 1 << fleet.causes[i][place] << place).end();
    for (const pool::FittedExplanation& one : result.ranking) {
      ++explanation;
      (explanations << explanation << i + 1 << one.name << one.probability << one.misfit << one.train_gain
                    << one.held_out_gain << one.on_bounds)
          .end();
      for (std::size_t c = 0; c < one.names.size(); ++c) {
        const auto at = static_cast<Eigen::Index>(c);
        const bool logarithmic = one.logarithmic[c], known = one.fit.covariance.rows() > at;
        (estimates << explanation << parameter_name(one.names[c]) << shown_value(one.fit.at[at], logarithmic)
                   << logarithmic << (known ? root(one.fit.covariance(at, at)) : root(-1.0))
                   << static_cast<bool>(one.at_bound[c]))
            .end();
      }
    }
  }
  Rows families(database, "family", 6), spreads(database, "spread", 9);
  for (std::size_t f = 0; f < verdict.families.size(); ++f) {
    const pool::Family& family = verdict.families[f];
    const pool::Prevalence& how = family.prevalence;
    (families << f + 1 << family.cause << how.share << how.share90.low << how.share90.high << how.units)
        .end();
    for (std::size_t c = 0; c < family.coordinates.size() && family.spread.size() > 0; ++c) {
      const auto at = static_cast<Eigen::Index>(c);
      const bool logarithmic = family.logarithmic[c];
      const pool::Range range = pool::prediction_range(family.spread, at, 0.9);
      (spreads << f + 1 << parameter_name(family.coordinates[c])
               << shown_value(family.spread.mean[at], logarithmic) << logarithmic
               << root(family.spread.between(at, at)) << root(family.scatter[c].variance)
               << static_cast<bool>(family.differs[c]) << shown_value(range.low, logarithmic)
               << shown_value(range.high, logarithmic))
          .end();
    }
  }
  Rows units(database, "unit", 11), parameters(database, "unit_parameter", 7), drifts(database, "drift", 8);
  for (std::size_t u = 0; u < verdict.units.size(); ++u) {
    const pool::UnitVerdict& unit = verdict.units[u];
    const pool::Family* family =
        unit.family >= 0 ? &verdict.families[static_cast<std::size_t>(unit.family)] : nullptr;
    const bool compared = family != nullptr && unit.estimate && family->spread.size() > 0;
    units << u + 1 << unit.unit << unit.logs.size();
    if (family != nullptr) units.whole(unit.family + 1);
    else units.none();
    units << unit.member << unit.own_cause << to_string(unit.oddity);
    if (compared)
      units << parameter_name(family->coordinates[static_cast<std::size_t>(unit.standing.coordinate)])
            << unit.standing.standard_deviations << unit.standing.p;
    else units.none().none().none();
    (units << unit.misfit).end();
    for (std::size_t c = 0; compared && c < family->coordinates.size(); ++c) {
      const auto at = static_cast<Eigen::Index>(c);
      const bool logarithmic = family->logarithmic[c];
      (parameters << u + 1 << parameter_name(family->coordinates[c])
                  << shown_value(unit.shrunken->at[at], logarithmic) << logarithmic
                  << root(unit.shrunken->covariance(at, at))
                  << shown_value(unit.estimate->at[at], logarithmic)
                  << root(unit.estimate->covariance(at, at)))
          .end();
    }
    for (const pool::UnitDrift& one : unit.drifts) {
      const auto place = std::find(family->coordinates.begin(), family->coordinates.end(), one.coordinate);
      const bool logarithmic =
          family->logarithmic[static_cast<std::size_t>(place - family->coordinates.begin())];
      (drifts << u + 1 << parameter_name(one.coordinate) << to_string(one.drift.kind)
              << (logarithmic ? std::expm1(one.drift.size) : one.drift.size) << logarithmic << one.drift.since
              << one.drift.until << one.drift.p)
          .end();
    }
  }
  Rows weak(database, "weak_effect", 6);
  for (const pool::WeakEffect& one : verdict.weak)
    (weak << one.explanation << one.stands << one.units << one.held_out_median << one.gain << one.p).end();
  database.run(
      "CREATE INDEX estimate_of ON estimate(explanation); CREATE INDEX explanation_of ON explanation(log); "
      "COMMIT;");
}

}  // namespace

std::string fleet_database(const FleetResults& fleet, const std::string& folder) {
  // Written beside its place, so that the folder's file system has room for it or says so, and read back as bytes.
  std::string path = folder + "/.fleet.sqlite.XXXXXX";
  const int descriptor = mkstemp(path.data());
  if (descriptor < 0) throw io::OutputError(path + ": cannot be written");
  close(descriptor);
  const std::unique_ptr<const std::string, void (*)(const std::string*)> removed(
      &path, [](const std::string* name) { unlink(name->c_str()); });
  {
    Database database(path);
    fill(database, fleet);
  }
  return read_text(path);
}

#else

std::string fleet_database(const FleetResults&, const std::string&) { return {}; }

#endif
