// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "robot_files.hpp"

#include <cmath>
#include <cstdio>
#include <regex>

namespace thermopower::robot {
namespace {

struct Tag {
  std::size_t begin = 0, end = 0;  // end: behind '>'
};

// An attribute's value in a tag; nothing where it has none.
bool find_attribute(const std::string& tag, const std::string& name, std::size_t& begin, std::size_t& end) {
  const std::regex pattern("[\\s]" + name + "\\s*=\\s*(\"([^\"]*)\"|'([^']*)')");
  std::smatch found;
  if (!std::regex_search(tag, found, pattern)) return false;
  const auto group = found[2].matched ? 2 : 3;
  begin = static_cast<std::size_t>(found.position(static_cast<std::size_t>(group)));
  end = begin + static_cast<std::size_t>(found.length(static_cast<std::size_t>(group)));
  return true;
}

std::string attribute(const std::string& tag, const std::string& name) {
  std::size_t begin = 0, end = 0;
  return find_attribute(tag, name, begin, end) ? tag.substr(begin, end - begin) : std::string();
}

void set_attribute(std::string& tag, const std::string& name, const std::string& value) {
  std::size_t begin = 0, end = 0;
  if (find_attribute(tag, name, begin, end)) {
    tag.replace(begin, end - begin, value);
    return;
  }
  std::size_t at = tag.size() - 1;
  if (at > 0 && tag[at - 1] == '/') --at;
  while (at > 0 && tag[at - 1] == ' ') --at;
  tag.insert(at, " " + name + "=\"" + value + "\"");
}

// Tags of that name, comments skipped.
std::vector<Tag> tags(const std::string& text, const std::string& name) {
  std::vector<Tag> out;
  for (std::size_t at = 0; at < text.size();) {
    at = text.find('<', at);
    if (at == std::string::npos) break;
    if (text.compare(at, 4, "<!--") == 0) {
      const std::size_t end = text.find("-->", at);
      if (end == std::string::npos) break;
      at = end + 3;
      continue;
    }
    const std::size_t end = text.find('>', at);
    if (end == std::string::npos) break;
    if (text.compare(at + 1, name.size(), name) == 0) {
      const char after = text[at + 1 + name.size()];
      if (after == ' ' || after == '\t' || after == '\n' || after == '\r' || after == '/' || after == '>')
        out.push_back({at, end + 1});
    }
    at = end + 1;
  }
  return out;
}

std::string indent_of(const std::string& text, std::size_t at) {
  const std::size_t line = text.rfind('\n', at);
  const std::size_t begin = line == std::string::npos ? 0 : line + 1;
  std::string out = text.substr(begin, at - begin);
  return out.find_first_not_of(" \t") == std::string::npos ? out : std::string();
}

// "damping 0.6 -> 0.21 N m s/rad": a comment may hold no two hyphens in a row, so the arrow is a word.
std::string change_text(const Change& change) {
  std::string out = change.name + " " + four_digits(change.from) + " to " + four_digits(change.to);
  if (std::isfinite(change.error) && change.error > 0.0)
    out += " (standard error " + four_digits(change.error) + ")";
  return out + (change.unit == "1" ? "" : " " + change.unit);
}

std::string joined(const std::vector<std::string>& parts) {
  std::string out;
  for (const std::string& one : parts) out += (out.empty() ? "" : "; ") + one;
  return out;
}

// Puts a comment above a tag, and the new tag in its place.
void replace(std::string& text, const Tag& tag, const std::string& with, const std::string& comment) {
  const std::string indent = indent_of(text, tag.begin);
  text.replace(tag.begin, tag.end - tag.begin, with);
  text.insert(tag.begin, "<!-- thermopower: " + comment + " -->\n" + indent);
}

bool find_joint(const std::string& text, const std::string& name, Tag& out) {
  for (const Tag& tag : tags(text, "joint"))
    if (attribute(text.substr(tag.begin, tag.end - tag.begin), "name") == name) {
      out = tag;
      return true;
    }
  return false;
}

}  // namespace

AmendedFile amended_mjcf(const std::string& text, const RobotDiagnosis& robot) {
  AmendedFile out;
  out.text = text;
  for (const JointDiagnosis& joint : robot.joints) {
    if (joint.causes.empty()) continue;
    Tag tag;
    if (!find_joint(out.text, joint.name, tag)) {
      out.left_out.push_back(joint.name + " is not in this file but in one that it includes");
      continue;
    }
    std::string with = out.text.substr(tag.begin, tag.end - tag.begin);
    std::vector<std::string> said, cannot;
    const JointDynamics& d = joint.found;
    const bool has_spring = d.stiffness > 0.0 && d.stiffness != joint.configured.stiffness;
    for (const Change& change : joint.changes) {
      if (change.name == "armature" || change.name == "damping") {
        set_attribute(with, change.name, four_digits(change.to));
        said.push_back(change_text(change));
      } else if (change.name == "friction") {
        set_attribute(with, "frictionloss", four_digits(change.to));
        said.push_back(change_text(change));
      } else if (has_spring && change.name == "stiffness") {
        set_attribute(with, "stiffness", four_digits(change.to));
        set_attribute(with, "springref", four_digits(-d.bias / d.stiffness));
        said.push_back(change_text(change) + ", with what is constant in springref");
      } else if (!(has_spring && change.name == "constant")) {
        cannot.push_back(change_text(change));
      }
    }
    std::string comment = joint.name + ": " + joined(said);
    if (!cannot.empty()) {
      comment += (said.empty() ? "" : ". ") + std::string("MJCF has no place for: ") + joined(cannot);
      out.left_out.push_back(joint.name + ": " + joined(cannot));
    }
    replace(out.text, tag, with, comment);
  }
  return out;
}

AmendedFile amended_urdf(const std::string& text, const RobotDiagnosis& robot) {
  AmendedFile out;
  out.text = text;
  for (const JointDiagnosis& joint : robot.joints) {
    if (joint.causes.empty()) continue;
    Tag tag;
    if (!find_joint(out.text, joint.name, tag)) {
      out.left_out.push_back(joint.name + " is not in this file");
      continue;
    }
    std::vector<std::string> said, cannot;
    for (const Change& change : joint.changes)
      (change.name == "damping" || change.name == "friction" ? said : cannot).push_back(change_text(change));
    std::string comment = joint.name + ": " + joined(said);
    if (!cannot.empty()) {
      comment += (said.empty() ? "" : ". ") + std::string("URDF has no place for: ") + joined(cannot);
      out.left_out.push_back(joint.name + ": " + joined(cannot));
    }
    const std::size_t close = out.text.find("</joint>", tag.end);
    Tag dynamics;
    bool has_dynamics = false;
    for (const Tag& one : tags(out.text, "dynamics"))
      if (one.begin > tag.begin && one.begin < close) dynamics = one, has_dynamics = true;
    std::string with =
        has_dynamics ? out.text.substr(dynamics.begin, dynamics.end - dynamics.begin) : "<dynamics/>";
    set_attribute(with, "damping", four_digits(joint.found.damping));
    set_attribute(with, "friction", four_digits(joint.found.friction));
    if (has_dynamics) {
      replace(out.text, dynamics, with, comment);
    } else {
      const std::string indent = indent_of(out.text, tag.begin) + "  ";
      out.text.insert(tag.end, "\n" + indent + "<!-- thermopower: " + comment + " -->\n" + indent + with);
    }
  }
  return out;
}

}  // namespace thermopower::robot
