#include "shared/net/stream/HalfOpenLimit.h"

#include <algorithm>

namespace naiad {

std::array<AddressPrefix, 3> HalfOpenLimit::widthsOf(const AddressPrefix& prefix) {
  return {prefix, prefix.wide(), prefix.widest()};
}

HalfOpenLimit::Result HalfOpenLimit::check(const AddressPrefix& prefix) const {
  using Kind = Result::Kind;
  if (greeted_ >= limits_.total) return {Kind::kFull};
  if (exceedsShare(prefix)) return {Kind::kFullForPrefix};
  const auto own = groups_[0].find(prefix);
  if (own != groups_[0].end() && own->second.silent + own->second.greeted >= limits_.per_prefix) {
    const auto oldest = oldestSilent(prefix);
    return oldest ? Result{Kind::kEvictFirst, *oldest} : Result{Kind::kFullForPrefix};
  }
  if (count() < limits_.total) return {};
  return {Kind::kEvictFirst, *oldestOfMostCrowded()};  // some are silent, else kFull was returned
}

// Tests only the widest prefix, which has at least as many connections as the narrower ones in it.
bool HalfOpenLimit::exceedsShare(const AddressPrefix& prefix) const {
  const auto group = groups_.back().find(prefix.widest());
  return group != groups_.back().end() && group->second.greeted >= limits_.total - greeted_;
}

std::optional<HalfOpenLimit::Id> HalfOpenLimit::oldestSilent(const AddressPrefix& prefix) const {
  const auto found = std::find_if(by_id_.begin(), by_id_.end(), [&prefix](const auto& entry) {
    return !entry.second.greeted && entry.second.prefix == prefix;
  });
  return found != by_id_.end() ? std::optional(found->first) : std::nullopt;
}

// Returns the oldest silent connection of the most crowded prefix: first the most crowded widest prefix, then
// the most crowded narrower ones in it.
std::optional<HalfOpenLimit::Id> HalfOpenLimit::oldestOfMostCrowded() const {
  std::optional<Id> oldest;
  std::array<std::size_t, 3> most{};
  for (const auto& [id, entry] : by_id_) {
    if (entry.greeted) continue;
    const auto& groups = entry.groups;
    const std::array crowd{groups[2]->second.silent, groups[1]->second.silent, groups[0]->second.silent};
    if (crowd <= most) continue;
    most = crowd;
    oldest = id;
  }
  return oldest;
}

void HalfOpenLimit::admit(Id id, const AddressPrefix& prefix) {
  HalfOpenConnection entry{.prefix = prefix, .groups = {}};
  const auto widths = widthsOf(prefix);
  for (std::size_t width = 0; width < widths.size(); ++width) {
    entry.groups[width] = groups_[width].try_emplace(widths[width]).first;
    ++entry.groups[width]->second.silent;
  }
  by_id_.emplace_hint(by_id_.end(), id, entry);
}

bool HalfOpenLimit::onHello(Id id) {
  HalfOpenConnection& entry = by_id_.at(id);
  if (entry.greeted) return true;
  if (exceedsShare(entry.prefix)) return false;
  entry.greeted = true;
  ++greeted_;
  for (const auto& group : entry.groups) {
    --group->second.silent;
    ++group->second.greeted;
  }
  return true;
}

void HalfOpenLimit::release(Id id) {
  const HalfOpenConnection& entry = by_id_.at(id);
  if (entry.greeted) --greeted_;
  for (std::size_t width = 0; width < entry.groups.size(); ++width) {
    Group& group = entry.groups[width]->second;
    --(entry.greeted ? group.greeted : group.silent);
    if (group.silent + group.greeted == 0) groups_[width].erase(entry.groups[width]);
  }
  by_id_.erase(id);
}

bool HalfOpenLimit::isSilent(Id id) const {
  const auto found = by_id_.find(id);
  return found != by_id_.end() && !found->second.greeted;
}

}  // namespace naiad
