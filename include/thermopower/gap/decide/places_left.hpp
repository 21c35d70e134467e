// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/fit/attribution.hpp>
#include <thermopower/gap/localise/localisation.hpp>

#include <string>
#include <utility>
#include <vector>

namespace thermopower::gap::engine {

/// Where a model with the causes of a candidate and the training rows part. Each candidate is looked at once, however many
/// questions are asked about it.
class PlacesLeft {
public:
  /// Keeps references to all: they must outlive this object. @param train  may be filled after this object was made
  PlacesLeft(const Model& model, const std::vector<Recording>& train, const Catalogue& catalogue)
      : model_(model), train_(train), catalogue_(catalogue) {}

  /// The places, the largest first; none of a plant of one's own, which need not say where. The reference holds until the
  /// next call.
  const std::vector<Location>& beside(const Candidate& known) {
    std::vector<std::string> ids = known.explanation.ids(model_);
    for (const Looked& one : looked_)
      if (one.ids == ids && one.point.size() == known.fit.point.size() && one.point == known.fit.point)
        return one.where;
    std::vector<Location> where;
    if (!model_.own)
      where =
          localise(augmented(model_, known.explanation, known.list, known.fit.point), train_, {}, catalogue_)
              .where;
    looked_.push_back({std::move(ids), known.fit.point, std::move(where)});
    return looked_.back().where;
  }

private:
  struct Looked {
    std::vector<std::string> ids;
    Eigen::VectorXd point;
    std::vector<Location> where;
  };

  const Model& model_;
  const std::vector<Recording>& train_;
  const Catalogue& catalogue_;
  std::vector<Looked> looked_;
};

}  // namespace thermopower::gap::engine
