// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "field_tree.hpp"

#include <algorithm>
#include <limits>

namespace thermopower::io {
namespace {

constexpr std::size_t most_nodes = 4096;  // a message that uses names as numbers would make ever more

}  // namespace

double FieldTree::missing() { return std::numeric_limits<double>::quiet_NaN(); }

FieldNode* FieldTree::grown(FieldNode& node, const std::string& name) {
  if (nodes_ >= most_nodes) return nullptr;
  ++nodes_;
  auto child = std::make_unique<FieldNode>();
  child->name = name;
  FieldNode* const result = child.get();
  if (name == "[]") node.elements = std::move(child);
  else node.members.push_back(std::move(child));
  return result;
}

FieldNode* FieldTree::follow(const std::string& path, bool make) {
  FieldNode* node = &root_;
  for (std::size_t at = 0; at < path.size();) {
    FieldNode* found = nullptr;
    std::string name = "[]";
    if (path.compare(at, 2, "[]") == 0) {
      found = node->elements.get();
      at += 2;
    } else {
      at += path[at] == '.' ? 1 : 0;
      const std::size_t end = std::min(path.find_first_of(".[", at), path.size());
      name = path.substr(at, end - at);
      for (const auto& one : node->members)
        if (one->name == name) found = one.get();
      at = end;
    }
    if (found == nullptr && make) found = grown(*node, name);
    if (found == nullptr && make)
      throw FieldError("more than " + std::to_string(most_nodes) + " fields are asked for");
    if (found == nullptr) return nullptr;
    node = found;
  }
  return node;
}

}  // namespace thermopower::io
