// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <Eigen/Core>

#include <limits>
#include <vector>

namespace thermopower::robot {

/// @brief The assignment of columns to rows with the least sum of costs (Kuhn 1955; shortest augmenting paths).
/// @param cost  square, finite
/// @return for each row its column
inline std::vector<int> cheapest_assignment(const Eigen::MatrixXd& cost) {
  const auto n = static_cast<int>(cost.rows());
  const auto places = static_cast<std::size_t>(n) + 1;
  // Row and column 0 are the path's start.
  std::vector<double> row_price(places, 0.0), column_price(places, 0.0);
  std::vector<int> row_of(places, 0), before(places, 0);
  for (int row = 1; row <= n; ++row) {
    row_of[0] = row;
    int column = 0;
    std::vector<double> least(places, std::numeric_limits<double>::infinity());
    std::vector<char> seen(places, 0);
    do {
      const auto at = static_cast<std::size_t>(column);
      seen[at] = 1;
      const int of = row_of[at];
      double step = std::numeric_limits<double>::infinity();
      int next = 0;
      for (int k = 1; k <= n; ++k) {
        const auto to = static_cast<std::size_t>(k);
        if (seen[to] != 0) continue;
        const double reduced =
            cost(of - 1, k - 1) - row_price[static_cast<std::size_t>(of)] - column_price[to];
        if (reduced < least[to]) least[to] = reduced, before[to] = column;
        if (least[to] < step) step = least[to], next = k;
      }
      for (std::size_t k = 0; k < places; ++k) {
        if (seen[k] != 0) {
          row_price[static_cast<std::size_t>(row_of[k])] += step;
          column_price[k] -= step;
        } else {
          least[k] -= step;
        }
      }
      column = next;
    } while (row_of[static_cast<std::size_t>(column)] != 0);
    while (column != 0) {
      const int from = before[static_cast<std::size_t>(column)];
      row_of[static_cast<std::size_t>(column)] = row_of[static_cast<std::size_t>(from)];
      column = from;
    }
  }
  std::vector<int> out(static_cast<std::size_t>(n), 0);
  for (int k = 1; k <= n; ++k) out[static_cast<std::size_t>(row_of[static_cast<std::size_t>(k)] - 1)] = k - 1;
  return out;
}

}  // namespace thermopower::robot
