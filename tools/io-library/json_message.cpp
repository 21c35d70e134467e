// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "json_message.hpp"

#include <charconv>
#include <cstring>
#include <limits>
#include <string>
#include <utility>

namespace thermopower::io {
namespace {

class Walk {
public:
  Walk(ByteView message, FieldTree& tree)
      : begin_(reinterpret_cast<const char*>(message.data)),
        at_(begin_),
        end_(begin_ + message.size),
        tree_(tree) {}

  void run() {
    value(&tree_.root(), 0, 0, 0);
    spaces();
    if (at_ != end_) fail("the end of the message");
  }

private:
  static constexpr unsigned deepest = 64;

  [[noreturn]] void fail(const char* expected) const {
    throw FieldError("byte " + std::to_string(at_ - begin_) + " of the JSON text: expected " + expected +
                     (at_ == end_ ? ", and it ends there" : std::string(", not '") + *at_ + "'"));
  }

  void spaces() {
    while (at_ != end_ && (*at_ == ' ' || *at_ == '\n' || *at_ == '\t' || *at_ == '\r')) ++at_;
  }

  bool next_is(char c) {
    spaces();
    if (at_ == end_ || *at_ != c) return false;
    ++at_;
    return true;
  }

  bool word(const char* text) {
    const std::size_t size = std::strlen(text);
    if (static_cast<std::size_t>(end_ - at_) < size || std::memcmp(at_, text, size) != 0) return false;
    at_ += size;
    return true;
  }

  void value(FieldNode* node, std::size_t index, unsigned lists, unsigned depth) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    if (depth > deepest) fail("at most 64 brackets inside each other");
    if (next_is('{')) return members(node, index, lists, depth);
    if (next_is('[')) return elements(lists == 0 ? tree_.elements(node) : nullptr, lists, depth);
    if (next_is('"')) {
      text(node != nullptr);
      if (node != nullptr) tree_.put(node, index, std::move(text_));
      return;
    }
    double number = 0.0;
    if (at_ != end_ && (*at_ == '-' || (*at_ >= '0' && *at_ <= '9'))) {
      if (word("-Infinity")) {
        number = -infinity;
      } else {
        const auto [end, error] = std::from_chars(at_, end_, number);
        const char* const last = at_ + (*at_ == '-' ? 1 : 0);
        if (last == end_ || *last < '0' || *last > '9' || error == std::errc::invalid_argument)
          fail("a number");
        if (error == std::errc::result_out_of_range) number = out_of_range(at_, end);
        at_ = end;
      }
    } else if (word("true")) {
      number = 1.0;
    } else if (word("null") || word("NaN")) {
      number = std::numeric_limits<double>::quiet_NaN();
    } else if (word("Infinity")) {
      number = infinity;
    } else if (!word("false")) {
      fail("a value");
    }
    tree_.put(node, index, number);
  }

  // Too small is zero for every purpose here; too large is told by whoever wants the number.
  static double out_of_range(const char* begin, const char* end) {
    return std::strtod(std::string(begin, end).c_str(), nullptr);
  }

  void members(FieldNode* node, std::size_t index, unsigned lists, unsigned depth) {
    if (next_is('}')) return;
    do {
      if (!next_is('"')) fail("'\"' and the name of a member");
      const char* const name = at_;
      const char* const quote =
          static_cast<const char*>(std::memchr(at_, '"', static_cast<std::size_t>(end_ - at_)));
      FieldNode* child = nullptr;
      if (quote != nullptr && std::memchr(name, '\\', static_cast<std::size_t>(quote - name)) == nullptr) {
        at_ = quote + 1;
        child = tree_.member(node, name, static_cast<std::size_t>(quote - name));
      } else {
        text(true);
        child = tree_.member(node, text_.data(), text_.size());
      }
      if (!next_is(':')) fail("':'");
      value(child, index, lists, depth + 1);
    } while (next_is(','));
    if (!next_is('}')) fail("',' or '}'");
  }

  void elements(FieldNode* node, unsigned lists, unsigned depth) {
    if (next_is(']')) return;
    std::size_t index = 0;
    do value(node, index++, lists + 1, depth + 1);
    while (next_is(','));
    if (!next_is(']')) fail("',' or ']'");
  }

  unsigned hexadecimal() {
    unsigned code = 0;
    if (end_ - at_ < 4) fail("four hexadecimal digits");
    const auto [end, error] = std::from_chars(at_, at_ + 4, code, 16);
    if (error != std::errc() || end != at_ + 4) fail("four hexadecimal digits");
    at_ += 4;
    return code;
  }

  void add_code(unsigned code) {
    if (code < 0x80) {
      text_ += static_cast<char>(code);
      return;
    }
    const int more = code < 0x800 ? 1 : code < 0x10000 ? 2 : 3;
    const unsigned first[] = {0, 0xc0, 0xe0, 0xf0};
    text_ += static_cast<char>(first[more] | code >> 6 * more);
    for (int i = more - 1; i >= 0; --i) text_ += static_cast<char>(0x80 | (code >> 6 * i & 0x3f));
  }

  // A text after its opening quote.
  void text(bool wanted) {
    text_.clear();
    for (;; ++at_) {
      if (at_ == end_) fail("'\"' at the end of a text");
      if (*at_ == '"') break;
      if (*at_ != '\\') {
        if (wanted) text_ += *at_;
        continue;
      }
      if (++at_ == end_) fail("'\"' at the end of a text");
      static const char escapes[] = "\"\\/bfnrt", meant[] = "\"\\/\b\f\n\r\t";
      if (*at_ == 'u') {
        ++at_;
        unsigned code = hexadecimal();
        if (code >= 0xd800 && code < 0xdc00 && word("\\u"))
          code = 0x10000 + ((code & 0x3ff) << 10) + (hexadecimal() & 0x3ff);
        add_code(code);
        --at_;
      } else {
        const char* const found = std::strchr(escapes, *at_);
        if (*at_ == 0 || found == nullptr) fail("an escape of JSON");
        text_ += meant[found - escapes];
      }
    }
    ++at_;
  }

  const char* const begin_;
  const char* at_;
  const char* const end_;
  FieldTree& tree_;
  std::string text_;
};

}  // namespace

void read_json_message(ByteView message, FieldTree& tree) { Walk(message, tree).run(); }

}  // namespace thermopower::io
