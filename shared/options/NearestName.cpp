#include "shared/options/NearestName.h"

#include <algorithm>
#include <cstddef>

namespace naiad {

namespace {

constexpr std::size_t kLongest = 64;  ///< what is longer is no name

/// Optimal string alignment distance, by rows.
std::size_t distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> before(b.size() + 1);
  std::vector<std::size_t> last(b.size() + 1);
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], before[j - 2] + 1);
    }
    before.swap(last);
    last.swap(row);
  }
  return last[b.size()];
}

}  // namespace

std::string nearestName(const std::string& typed, const std::vector<std::string>& names) {
  if (typed.size() > kLongest) return {};
  std::string nearest;
  std::size_t least = typed.size() / 3 + 1;
  constexpr std::size_t kBeginning = 4;  // of "--max-players", "--m" could be anything
  for (const std::string& name : names) {
    const bool begins = typed.size() >= kBeginning && name.starts_with(typed);
    const std::size_t changes = begins ? 1 : distance(typed, name);
    if (changes >= least) continue;
    least = changes;
    nearest = name;
  }
  return nearest;
}

}  // namespace naiad
