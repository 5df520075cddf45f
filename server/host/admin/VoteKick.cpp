#include "host/admin/VoteKick.h"

#include <algorithm>

namespace naiad {

namespace {

AddressPrefix voterAt(const AdminPlayer& player) {
  return AddressPrefix::ofEndpoint(player.address).value_or(AddressPrefix());
}

const AdminPlayer* findSession(const std::vector<AdminPlayer>& players, std::uint64_t session) {
  const auto found = std::find_if(players.begin(), players.end(),
                                  [session](const AdminPlayer& player) { return player.session == session; });
  return found != players.end() ? &*found : nullptr;
}

}  // namespace

// Voters may have left since they agreed: their voices go, too.
void VoteKick::count(const std::vector<AdminPlayer>& players) {
  std::set<AddressPrefix> voters;
  for (const AdminPlayer& player : players) {
    if (!player.detached) voters.insert(voterAt(player));
  }
  std::erase_if(m_voices, [&voters](const AddressPrefix& voice) { return !voters.contains(voice); });
  m_needed = std::max<std::size_t>(2, voters.size() / 2 + 1);
}

VoteKick::Outcome VoteKick::vote(const std::vector<AdminPlayer>& players, std::uint64_t voter,
                                 std::uint64_t target, Time now) {
  const AdminPlayer* const p_voter = findSession(players, voter);
  const AdminPlayer* const p_target = findSession(players, target);
  if (p_voter == nullptr || p_target == nullptr) return Outcome::kSelf;
  const AddressPrefix voice = voterAt(*p_voter);
  if (voice == voterAt(*p_target)) return Outcome::kSelf;
  if (m_target && now >= m_ends) m_target.reset();
  const bool begins = !m_target;
  if (begins) {
    Begun& begun = m_begun.use(voice);
    if (begun.at && now - *begun.at < kBetween) return Outcome::kTooSoon;
    begun.at = now;
    m_target = target;
    m_ends = now + kTime;
    m_voices.clear();
  }
  if (*m_target != target) return Outcome::kOther;
  const bool is_new = m_voices.insert(voice).second;
  count(players);
  if (m_voices.size() >= m_needed) {
    m_target.reset();
    return Outcome::kPassed;
  }
  return begins ? Outcome::kBegun : is_new ? Outcome::kAgreed : Outcome::kAlready;
}

std::optional<std::uint64_t> VoteKick::takeFailed(Time now) {
  if (!m_target || now < m_ends) return std::nullopt;
  const std::uint64_t target = *m_target;
  m_target.reset();
  return target;
}

}  // namespace naiad
