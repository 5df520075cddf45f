#include "host/snapshot/LookCatalogue.h"

#include "shared/replica/LookCodec.h"

namespace naiad {

namespace {

/// Above this number of looks, those not entered for kForgetAfter ticks are forgotten.
constexpr std::size_t kMaxRemembered = 16'384;
constexpr std::uint32_t kForgetAfter = 9'000;
/// Sequences kept to be shared, whether an object still has them or not.
constexpr std::size_t kMaxShared = 2'048;

}  // namespace

// A text that changes all the time never recurs.
void LookCatalogue::enterLook(PublishedModel& model, std::uint32_t tick) {
  Look& look = model.state.look;
  model.look_sum = 0;
  model.recurs = false;
  share(look.sequence);
  if (look.sequence.empty() || isSingleCharacter(look.sequence)) return;
  model.look_sum = look.sequence.sum();
  const auto [known, fresh] = m_last_used.try_emplace(model.look_sum, tick);
  model.recurs = !fresh || look.sequence.size() > 1;
  known->second = tick;
  if (m_last_used.size() <= kMaxRemembered) return;
  std::erase_if(m_last_used, [tick](const auto& used) { return tick - used.second > kForgetAfter; });
  if (m_last_used.size() > kMaxRemembered) m_last_used.clear();
}

// Objects that look the same share one copy, since every tick compares it with what they draw.
void LookCatalogue::share(Sequence& sequence) {
  if (sequence.empty()) return;
  if (m_sequences.size() >= kMaxShared) m_sequences.clear();
  const auto [known, fresh] = m_sequences.try_emplace(sequence.sum(), sequence);
  if (!fresh && known->second == sequence) sequence = known->second;
}

}  // namespace naiad
