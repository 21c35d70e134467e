// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "robot_files.hpp"

#include "chart.hpp"
#include "html_text.hpp"
#include "report_style.hpp"

#include <thermopower/plant/radians.hpp>
#include <thermopower/robot/table.hpp>

#include <cctype>
#include <cmath>

namespace thermopower::robot {
namespace {

using io::escaped;
using io::readable;

const char* const own_style = R"css(
.joints td,.joints th{text-align:left;white-space:nowrap}.joints .num{text-align:right}.joints .cause{white-space:normal}
.joints a{color:var(--augmented)}section{break-inside:avoid-page}.top{font-size:13px}
@media (max-width:600px){.joints .wide{display:none}}
)css";

std::string anchor(const std::string& name) {
  std::string out = "joint-";
  for (const char c : name) out += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '-';
  return out;
}

std::string causes_text(const JointDiagnosis& joint) {
  std::string out;
  for (const Term& term : joint.causes) out += (out.empty() ? "" : ", ") + std::string(in_short(term.family));
  return out.empty() ? "none" : out;
}

std::string share_text(double share) { return std::isfinite(share) ? io::percent_html(share) : "–"; }

class Page {
public:
  explicit Page(const RobotDiagnosis& robot) : robot_(robot) {}

  std::string text() {
    const std::string name = robot_.robot.name.empty() ? "robot" : robot_.robot.name;
    out_ =
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>Robot report: " +
        escaped(name) + "</title>\n<style>" + io::report_style + own_style +
        "</style>\n</head>\n<body>\n<main id=\"top\">\n";
    out_ += "<div class=\"eyebrow\">Gap report of a robot</div>\n<h1>" + escaped(name) + "</h1>\n";
    summary();
    findings();
    table();
    groups();
    for (std::size_t j = 0; j < robot_.joints.size(); ++j) joint(j);
    out_ +=
        "<footer>Written by thermopower-gap. Tracking: root mean square error of the whole robot, simulated under "
        "the logged targets on rows that no fit has seen. Effort: what the model does not account for, by inverse "
        "dynamics, as a share of the joint's effort.</footer>\n</main>\n</body>\n</html>\n";
    return std::move(out_);
  }

private:
  void summary() {
    std::size_t explained = 0, partial = 0, without = 0, rest = 0, refused = 0;
    for (const JointDiagnosis& joint : robot_.joints) {
      explained += joint.verdict == JointVerdict::explained ? 1 : 0;
      partial += joint.verdict == JointVerdict::partial ? 1 : 0;
      without += joint.verdict == JointVerdict::no_gap ? 1 : 0;
      rest += joint.verdict == JointVerdict::unexplained ? 1 : 0;
      refused += joint.verdict == JointVerdict::not_judged ? 1 : 0;
    }
    const auto part = [](std::size_t count, const char* what) {
      return count == 0 ? std::string() : std::to_string(count) + " " + what + ", ";
    };
    std::string words = "Of " + std::to_string(robot_.joints.size()) +
                        " joints: " + part(without, "without a gap") + part(explained, "explained") +
                        part(partial, "explained in part") + part(rest, "unexplained") +
                        part(refused, "not judged");
    words.replace(words.size() - 2, 2, ".");
    if (std::isfinite(robot_.tracking.before))
      words += " The causes lower the tracking error of all joints together from " +
               readable(plant::deg_per_rad * robot_.tracking.before) + "° to " +
               readable(plant::deg_per_rad * robot_.tracking.after) + "°; refitted constants alone reach " +
               readable(plant::deg_per_rad * robot_.tracking.recalibrated) + "°.";
    out_ += "<p class=\"words\">" + words + "</p>\n<p class=\"from\">" + std::to_string(robot_.rows) +
            " rows fitted, " + std::to_string(robot_.held_out_rows) + " rows judged, effort " +
            (robot_.effort_is_measured ? "as measured" : "from targets and gains") + ".</p>\n";
  }

  void findings() {
    for (const WiringFinding& one : robot_.wiring)
      out_ += "<div class=\"finding warning\"><span class=\"tag\">Wiring</span>" +
              escaped(io::capital(one.text)) + "." + (one.mended ? " The log was put right here." : "") +
              "</div>\n";
    if (robot_.delay_s > 0.0)
      out_ += "<div class=\"finding note\"><span class=\"tag\">Delay</span>The whole bus is late by " +
              readable(1e3 * robot_.delay_s) + " ms.</div>\n";
    for (const std::string& one : robot_.notes)
      out_ += "<div class=\"finding note\"><span class=\"tag\">Note</span>" + escaped(io::capital(one)) +
              ".</div>\n";
  }

  static std::string verdict(JointVerdict one) {
    const std::string word = to_string(one);
    std::string text = word;
    for (char& c : text)
      if (c == '_') c = ' ';
    const std::string style = one == JointVerdict::not_judged ? "soft" : word;
    return "<span class=\"" + style + "\">" + text + "</span>";
  }

  void table() {
    out_ +=
        "<h2>Joints</h2>\n<table class=\"joints\">\n<tr><th>joint</th><th>verdict</th><th>cause</th>"
        "<th class=\"num wide\">effort left</th><th class=\"num\">tracking / °</th><th class=\"num\">taken</th></tr>\n";
    for (const JointDiagnosis& joint : robot_.joints) {
      out_ += "<tr><td><a href=\"#" + anchor(joint.name) + "\">" + io::breakable(joint.name) +
              "</a></td><td>" + verdict(joint.verdict) + "</td>";
      if (joint.verdict == JointVerdict::not_judged) {
        out_ += "<td class=\"cause\" colspan=\"4\">" + escaped(joint.reason) + "</td></tr>\n";
        continue;
      }
      out_ += "<td class=\"cause\">" + causes_text(joint) + "</td><td class=\"num wide\">" +
              share_text(joint.effort.before / joint.effort_rms) + " → " +
              share_text(joint.effort.after / joint.effort_rms) + "</td><td class=\"num\">" +
              (std::isfinite(joint.tracking.before)
                   ? readable(plant::deg_per_rad * joint.tracking.before, 2) + " → " +
                         readable(plant::deg_per_rad * joint.tracking.after, 2)
                   : std::string("–")) +
              "</td><td class=\"num\">" + (joint.causes.empty() ? "–" : share_text(share_taken(joint))) +
              "</td></tr>\n";
    }
    out_ += "</table>\n";
  }

  void groups() {
    bool any = false;
    for (const GroupDiagnosis& group : robot_.groups) {
      if (group.pooled.empty()) continue;
      if (!any)
        out_ +=
            "<h2>Joints that are built alike</h2>\n<table>\n<tr><th class=\"t\">joints</th><th class=\"t\">number</th>"
            "<th>model</th><th>mean</th><th>spread</th></tr>\n";
      any = true;
      bool first = true;
      for (const Change& one : group.pooled) {
        out_ += "<tr><td class=\"t\">" + (first ? io::breakable(group.name) : "") + "</td><td class=\"t\">" +
                io::breakable(one.name) + "</td><td>" + readable(one.from) + "</td><td>" +
                io::with_unit(readable(one.to), one.unit) + "</td><td>" + readable(one.error, 2) +
                "</td></tr>\n";
        first = false;
      }
      for (const int member : group.different) {
        const JointDiagnosis& joint = robot_.joints[static_cast<std::size_t>(member)];
        out_ += "<tr><td></td><td class=\"t\" colspan=\"4\"><b>" + io::breakable(joint.name) +
                "</b> differs: " + escaped(joint.difference) + "</td></tr>\n";
      }
    }
    if (any) out_ += "</table>\n";
  }

  void joint(std::size_t j) {
    const JointDiagnosis& joint = robot_.joints[j];
    out_ += "<section id=\"" + anchor(joint.name) + "\">\n<h2>" + io::breakable(joint.name) + ": " +
            verdict(joint.verdict) + "</h2>\n";
    if (joint.verdict == JointVerdict::not_judged) {
      out_ += "<p>Not judged: " + escaped(joint.reason) + ".</p>\n" + back() + "</section>\n";
      return;
    }
    std::string words = joint.causes.empty() ? "No cause is told." : "Causes: " + causes_text(joint) + ".";
    words += " The model as configured leaves " + share_text(joint.effort.before / joint.effort_rms) +
             " of the joint's effort; this answer leaves " +
             share_text(joint.effort.after / joint.effort_rms) + ".";
    if (std::isfinite(joint.tracking.before))
      words += " Its tracking error falls from " + readable(plant::deg_per_rad * joint.tracking.before) +
               "° to " + readable(plant::deg_per_rad * joint.tracking.after) + "° (" +
               readable(plant::deg_per_rad * joint.tracking.recalibrated) + "° with refitted constants).";
    if (joint.differs)
      words += " It differs from joints that are built alike: " + escaped(joint.difference) + ".";
    out_ += "<p>" + words + "</p>\n";
    if (!joint.changes.empty()) {
      out_ +=
          "<table>\n<tr><th class=\"t\">number</th><th>model</th><th>found</th><th>95 % interval</th></tr>\n";
      for (const Change& one : joint.changes)
        out_ += "<tr><td class=\"t\">" + io::breakable(one.name) + "</td><td>" + readable(one.from) +
                "</td><td>" + io::with_unit(readable(one.to), one.unit) + "</td><td>" +
                (std::isfinite(one.error) ? "[" + readable(one.to - 1.96 * one.error) + ", " +
                                                readable(one.to + 1.96 * one.error) + "]"
                                          : std::string("–")) +
                "</td></tr>\n";
      out_ += "</table>\n";
    }
    for (const Term& term : joint.causes) {
      if (term.predicts_alike.empty()) continue;
      std::string alike;
      for (const Family one : term.predicts_alike)
        alike += (alike.empty() ? "" : ", ") + std::string(in_short(one));
      out_ += "<p class=\"soft\">" + io::capital(in_short(term.family)) + " predicts like " + alike +
              ": this log does not tell them apart.</p>\n";
    }
    picture(j);
    out_ += back() + "</section>\n";
  }

  static std::string back() { return "<p class=\"top\"><a href=\"#top\">All joints</a></p>\n"; }

  void picture(std::size_t j) {
    const auto column = static_cast<Eigen::Index>(j);
    const Series& series = robot_.replayed;
    if (robot_.position_found.rows() == 0 || !std::isfinite(robot_.joints[j].tracking.before)) return;
    io::Chart chart;
    chart.title = "Tracking error of " + robot_.joints[j].name;
    chart.x_label = "time / s";
    chart.y_label = "simulated less measured / °";
    chart.zero_line = true;
    chart.height = 180;
    io::Series before, after;
    before.label = "as configured";
    before.role = "baseline";
    after.label = "with the causes";
    after.role = "augmented";
    for (Eigen::Index row = 0; row < series.rows(); ++row) {
      before.x.push_back(series.t_s[row]);
      before.y.push_back(plant::deg_per_rad *
                         (robot_.position_configured(row, column) - series.measured(row, column)));
      after.x.push_back(series.t_s[row]);
      after.y.push_back(plant::deg_per_rad *
                        (robot_.position_found(row, column) - series.measured(row, column)));
    }
    chart.series = {before, after};
    out_ += io::to_html(chart);
  }

  const RobotDiagnosis& robot_;
  std::string out_;
};

}  // namespace

std::string robot_html(const RobotDiagnosis& robot) { return Page(robot).text(); }

}  // namespace thermopower::robot
