// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Reports of diagnoses with any names, texts and numbers in them: the one for machines is JSON, the page has no element that is
// not its own, and stays below 300 KB besides the data.

#include <thermopower/io/report_html.hpp>
#include <thermopower/io/report_json.hpp>
#include <thermopower/io/summary.hpp>

#include <thermopower/plant/standard_catalogue.hpp>

#include <nlohmann/json.hpp>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

using namespace thermopower::gap;
namespace io = thermopower::io;
namespace plant = thermopower::plant;

namespace {

void require(bool holds, const char* claim) {
  if (holds) return;
  std::fprintf(stderr, "gap_report_fuzz: does not hold: %s\n", claim);
  std::abort();
}

/// What no page may have, unless a text of the diagnosis brings it into its code.
const char* const foreign = "<x-fuzz";

/// Takes values from bytes, in turn; of none left, zeros.
class Source {
public:
  Source(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}
  std::uint8_t byte() { return at_ < size_ ? data_[at_++] : std::uint8_t(0); }
  std::size_t below(std::size_t n) { return byte() % n; }
  double number() {
    static const double some[] = {0.0,  1.0,   -1.0,  0.5,  1e-300, 1e300,    -1e300,
                                  1e-3, 12.34, 1e308, -0.0, NAN,    INFINITY, -INFINITY};
    const std::uint8_t which = byte();
    if (which < 2 * sizeof some / sizeof some[0]) return some[which / 2];
    return (static_cast<double>(byte()) - 128.0) * (which % 7 == 0 ? 1e6 : 0.1);
  }
  std::string text() {
    std::string one;
    for (std::size_t count = below(24); count > 0; --count) one += static_cast<char>(byte());
    if (byte() % 4 == 0) one += std::string(foreign) + " onload=\"alert(1)\">&lt;'\"</script>";
    return one;
  }
  Eigen::VectorXd values(Eigen::Index size) {
    Eigen::VectorXd all(size);
    for (double& one : all) one = number();
    return all;
  }
  Interval interval() {
    const double low = number();
    return {low, number()};
  }

private:
  const std::uint8_t* data_;
  std::size_t size_, at_ = 0;
};

ParameterEstimate estimate(Source& from) {
  ParameterEstimate one;
  one.name = from.text();
  one.value = from.number();
  one.ci95 = from.interval();
  one.unit = from.text();
  one.at_bound = from.byte() % 2 == 0;
  return one;
}

Diagnosis diagnosis_of(Source& from) {
  static const Verdict verdicts[] = {Verdict::no_gap,    Verdict::explained,   Verdict::partial,
                                     Verdict::ambiguous, Verdict::unexplained, Verdict::insufficient};
  Diagnosis d;
  d.verdict = verdicts[from.below(6)];
  d.reason = from.text();
  d.next_experiment = from.text();
  d.recalibration = from.text();
  d.none_of_these = from.number();
  d.augmented.name = d.recalibrated.name = from.text();
  for (std::size_t i = from.below(3); i > 0; --i) {
    Location where;
    where.signal = plant::SignalName(from.text());
    where.submodel = plant::SubmodelName(from.text());
    where.share = from.number();
    where.evidence = from.text();
    if (from.byte() % 2 == 0) where.regime = Regime{from.text(), from.number(), from.number()};
    d.where.push_back(where);
  }
  for (std::size_t i = from.below(3); i > 0; --i) {
    Cause cause;
    cause.effect = from.text();
    cause.probability = from.number();
    for (std::size_t k = from.below(3); k > 0; --k) cause.parameters.push_back(estimate(from));
    d.cause.push_back(cause);
  }
  for (std::size_t i = from.below(3); i > 0; --i) {
    GapScore gap;
    gap.signal = plant::SignalName(from.text());
    gap.unit = from.text();
    gap.before = from.number();
    gap.recalibrated = from.number();
    gap.after = from.number();
    gap.noise_floor = from.number();
    gap.shrunk_by = from.number();
    gap.ci95 = from.interval();
    d.gap.push_back(gap);
  }
  for (std::size_t i = from.below(3); i > 0; --i) {
    Finding finding;
    finding.recording = from.text();
    finding.column = from.text();
    finding.message = from.text();
    finding.mend = from.text();
    d.findings.push_back(finding);
  }
  for (std::size_t i = from.below(3); i > 0; --i) {
    RankedExplanation one;
    one.effects = {from.text()};
    one.probability = from.number();
    one.score = from.number();
    one.parameters = {estimate(from)};
    one.confusable = {Likeness{{from.text()}, from.number()}};
    d.ranking.push_back(one);
  }
  for (std::size_t i = from.below(3); i > 0; --i) {
    SignalSeries series;
    series.signal = plant::SignalName(from.text());
    series.unit = from.text();
    series.recording = from.text();
    const Eigen::Index rows = static_cast<Eigen::Index>(from.below(9));
    series.t_s = from.values(rows);
    series.measured = from.values(rows);
    series.baseline = from.values(rows);
    series.recalibrated = from.values(rows);
    series.augmented = from.values(rows);
    d.series.push_back(series);
    MissingQuantity missing;
    missing.signal = series.signal;
    missing.quantity = plant::QuantityName(from.text());
    missing.unit = missing.variable_unit = from.text();
    missing.variable = from.text();
    missing.x = from.values(rows);
    missing.value = from.values(rows);
    missing.spread = from.values(rows);
    missing.effect_x = from.values(rows);
    missing.effect = from.values(rows);
    missing.effect_freedom = from.number();
    d.missing_quantities.push_back(missing);
  }
  d.constants.push_back({from.text(), from.number(), from.number(), from.number()});
  d.not_judged.push_back(from.text());
  return d;
}

}  // namespace

std::vector<std::string> fuzz_seeds() {
  return {std::string(400, '\0'), std::string(200, '\1') + std::string(200, '\x1e'), std::string(300, 'a'),
          std::string(150, '\x02') + std::string(150, '\xff')};
}
std::vector<std::string> fuzz_pieces() {
  return {"\x17", "<b>",       "&",  "\"",      "'", "\xff", "\xc3\x28", std::string(1, '\0'),
          "]]>",  "</script>", "\\", "\x01\x01"};
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Source from(data, size);
  const Diagnosis diagnosis = diagnosis_of(from);
  const std::string json = io::report_json(diagnosis);
  require(nlohmann::json::accept(json), "the report for machines is JSON");
  require(io::report_json(diagnosis) == json, "the same diagnosis gives the same bytes");
  const std::string page = io::report_html(diagnosis, from.text(), plant::standard_catalogue().list());
  require(page.find(foreign) == std::string::npos, "a text brings no element into the page");
  require(nlohmann::json::accept(nlohmann::json(page).dump()),
          "the page is UTF-8");  // dump() throws where not
  require(page.size() < 300000, "the page is below 300 KB besides the data");
  io::one_sentence(diagnosis);
  return 0;
}
