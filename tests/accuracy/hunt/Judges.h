// The judges of the hunt: what must hold in every scene of a kind, whatever the right motion is.
//
// docs/physics/lab.md lists them with their scopes. Wider scopes give false alarms on correct behaviour.
#pragma once

#include <initializer_list>
#include <optional>
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

/// A judge's answer: what it found, if anything.
struct Answer {
  Answer() = default;
  Answer(Finding found) : finding(std::move(found)) {}
  bool applies = true;
  std::optional<Finding> finding;
};
inline Answer notAsked() {
  Answer answer;
  answer.applies = false;
  return answer;
}

struct Judge {
  std::string name;
  Answer (*ask)(const Trial& trial);
  int share = 100;  ///< percentage of the scenes in which it is asked: some run the scene again
};

const std::vector<Judge>& judges();
/// Returns the judges that run a scene again in another form and compare. They are part of judges().
std::vector<Judge> rerunJudges();
/// Returns the judge of this name; null if not found.
const Judge* judgeNamed(const std::string& name);

/// Runs the scene and asks all judges, or only one. Returns the answers with their judges.
std::vector<std::pair<const Judge*, Answer>> judgeScene(const SceneData& scene,
                                                        const Judge* p_only = nullptr);

/// Returns the greatest mass of a dynamic body as a multiple of the least.
double massRatio(const SceneData& scene);
bool actsOn(const SceneData& scene, std::initializer_list<const char*> setters);
bool hasActions(const SceneData& scene);
/// True if masses differ by at most 10⁴, and springs and fields do not pull as if they were heavier.
bool isModerate(const Trial& trial);

}  // namespace hunt
