// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: this configuration cannot be stored: it needs static each_field(self, archive)

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

struct Own {
  float limit_C;
  tp::ConfigError validate() const { return tp::ConfigError::none; }
#if !defined(MISUSE)
  template <class Self, class Archive>
  static void each_field(Self& self, Archive& archive) {
    archive(self.limit_C);
  }
#endif
};

size_t size = tp::config_record_size(Own{60.0f});
