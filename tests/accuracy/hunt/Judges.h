// The judges of the hunt: what must hold in every scene of a kind, whatever the right motion is.
//
// NUMERICS.md, "The hunt", lists them with their scopes. Wider scopes give false alarms on correct behaviour.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "Recording.h"

namespace hunt {

/// A violation.
struct Finding {
  int tick = 0;
  double value = 0;
  double limit = 0;
  std::string text;
};

struct Trial {
  const SceneData& scene;
  const Recording& course;
};

struct Judge {
  const char* name;
  const char* rule;
  bool (*applies)(const Trial& trial);
  std::optional<Finding> (*find)(const Trial& trial);
  int share;  ///< percentage of the scenes in which it is asked: those that run the scene again take time
};

std::span<const Judge> judges();
/// Returns the judge of this name; null if not found.
const Judge* judgeNamed(const std::string& name);

struct Verdict {
  const Judge* p_judge = nullptr;
  bool applied = false;
  std::optional<Finding> finding;
};
/// Runs the scene and asks all judges, or only one.
std::vector<Verdict> judgeScene(const SceneData& scene, const Judge* p_only = nullptr);

}  // namespace hunt
