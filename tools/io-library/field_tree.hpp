// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#pragma once

#include <cstddef>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace thermopower::io {

/// @brief A field of a message: a structure with members, a list with elements, or a number or text.
///
/// Decoders walk this tree along a message and leave numbers and texts in its leaves. Fields that the tree does not
/// have are skipped, unless it grows. A leaf inside a list holds one entry for each element, in order; a list inside a
/// list is skipped.
struct FieldNode {
  std::string name;                                 ///< as a member; `[]` for the elements of a list
  std::vector<std::unique_ptr<FieldNode>> members;  ///< of a structure
  std::unique_ptr<FieldNode> elements;              ///< of a list: what each of them holds
  std::vector<double> numbers;                      ///< of the present message; NaN where an element has none
  std::vector<std::string> words;                   ///< likewise, where it is text
};

/// What a decoder throws: what is wrong with a message, and in which field.
struct FieldError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// @brief The fields of a topic's messages, those that are wanted or all.
class FieldTree {
public:
  /// @param grows  fields are added as they are met
  explicit FieldTree(bool grows) : grows_(grows) {}
  FieldTree(FieldTree&&) = default;
  FieldTree& operator=(FieldTree&&) = default;

  FieldNode& root() { return root_; }

  /// The field of a path such as `header.stamp.sec`, `position[]` or `motors[].temperature`; it is made where it is not.
  FieldNode& at(const std::string& path) { return *follow(path, true); }

  /// The field of a path; null where there is none.
  FieldNode* find(const std::string& path) { return follow(path, false); }

  /// A member while a message is walked; null: it is not wanted.
  FieldNode* member(FieldNode* node, const char* name, std::size_t size) {
    if (node == nullptr) return nullptr;
    // Messages tell their members in the same order again and again.
    const std::size_t count = node->members.size();
    for (std::size_t i = 0; i < count; ++i) {
      FieldNode& one = *node->members[i];
      if (one.name.size() == size && one.name.compare(0, size, name, size) == 0) return &one;
    }
    return grows_ ? grown(*node, std::string(name, size)) : nullptr;
  }

  /// What the elements of a list hold, while a message is walked; null: not wanted.
  FieldNode* elements(FieldNode* node) {
    if (node == nullptr) return nullptr;
    if (node->elements == nullptr && grows_) return grown(*node, "[]");
    return node->elements.get();
  }

  /// Leaves a number in a leaf. @param index  of the element of the list that it is in, 0 outside
  void put(FieldNode* node, std::size_t index, double value) {
    if (node == nullptr) return;
    if (index >= most_elements_ && grows_) return;
    if (node->numbers.size() <= index) {
      if (node->numbers.empty()) filled_.push_back(node);
      node->numbers.resize(index + 1, missing());
    }
    node->numbers[index] = value;
  }

  /// Likewise a text.
  void put(FieldNode* node, std::size_t index, std::string text) {
    if (node == nullptr) return;
    if (index >= most_elements_ && grows_) return;
    if (node->words.size() <= index) {
      if (node->words.empty()) filled_.push_back(node);
      node->words.resize(index + 1);
    }
    node->words[index] = std::move(text);
  }

  /// Before the next message.
  void clear() {
    for (FieldNode* node : filled_) {
      node->numbers.clear();
      node->words.clear();
    }
    filled_.clear();
  }

  /// The leaves that the present message filled.
  const std::vector<FieldNode*>& filled() const { return filled_; }

private:
  static double missing();
  FieldNode* follow(const std::string& path, bool make);
  FieldNode* grown(FieldNode& node, const std::string& name);

  FieldNode root_;
  std::vector<FieldNode*> filled_;
  std::size_t nodes_ = 0;
  std::size_t most_elements_ = 64;  ///< of a list that are looked at where the tree grows
  bool grows_;
};

}  // namespace thermopower::io
