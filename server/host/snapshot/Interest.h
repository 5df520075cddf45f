// Whom one client ought to know: the objects in its view and those about to enter it.
//
// Nobody is looked at in vain. What a model does is known until it changes, so between changes an object that
// flies straight has to be looked at only when it may come or go:
//
//   in      who changed is judged at once. Every kGap ticks the blocks around the view are searched for those
//           that may come into it before the next search; only these few are judged in each tick. Blocks
//           that lie in the view hold nobody new.
//   out     with the same search, and only those whose straight path may have led out by now. To forget
//           somebody late costs little.
//
// A view that moves is searched for with some cells to spare, and at once when those are used up.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "host/snapshot/KnownObjects.h"
#include "host/snapshot/Publisher.h"

namespace naiad {

class Interest {
 public:
  /// What the client looks at.
  struct Focus {
    CellRect window;                     ///< the view, and where it is about to be
    std::array<df::ObjectKey, 2> own{};  ///< of interest wherever they are
    std::uint32_t look_ahead = 0;        ///< ticks before it enters that an object is to be known
    std::uint32_t stagger = 0;           ///< any number, so that not all clients search in the same tick
  };
  /// To be called after every update of the publisher: owes `known` what changed, births and deaths.
  void update(const Publisher& publisher, const Focus& focus, KnownObjects& known);

  /// Is the object in the view, or will it be after `look_ahead` ticks?
  static bool isVisible(const Publisher::Model& model, std::uint32_t tick, std::uint32_t look_ahead,
                        const CellRect& window);

  /// Ticks between two searches.
  static constexpr std::uint32_t kGap = 8;
  /// An object that left the view is forgotten only this many cells outside, lest it come and go at the edge.
  static constexpr std::int64_t kHysteresis = 2;

 private:
  /// Cells to spare around a view that moves.
  static constexpr std::int64_t kSpare = 4;

  void noteChanges();
  void markChanges(ChangeIndex::Marks& marks) const;
  void noteChange(const Publisher::Change& change);
  void consider(std::uint32_t slot);
  void judgeCandidates();
  bool isSearchDue() const;
  void search();
  void forgetThoseOutside(const CellRect& outer, bool moves);
  bool isOwn(std::uint32_t id, std::uint32_t slot) const;
  std::uint32_t leavesAfter(const Publisher::Model& model, const CellRect& outer) const;
  void learn(std::uint32_t slot, std::uint32_t generation);
  const Publisher::Outlook& outlook(std::uint32_t slot) const {
    return m_p_publisher->outlook(slot, m_focus.look_ahead, kGap + m_focus.look_ahead);
  }
  // Most of what happens in the world happens to others than those that the client knows: a bit for each
  // slot, modulo their number, answers for them without a look into the table; in a world of fewer slots (the
  // last bit is the loose one's) for all.
  static_assert(kLooseSlot % SlotBits::kBits == SlotBits::kBits - 1);
  bool bitsAreExact() const { return m_p_publisher->slotCount() < SlotBits::kBits; }
  bool mayBeKnown(std::uint32_t slot) const { return m_known_bits.has(slot); }
  bool isKnown(std::uint32_t slot) const {
    return mayBeKnown(slot) && (bitsAreExact() || m_p_known->find(slot) != KnownObjects::kNobody);
  }
  void forget(std::uint32_t id, std::uint32_t slot);

  const Publisher* m_p_publisher = nullptr;  ///< these three only during update()
  KnownObjects* m_p_known = nullptr;
  std::uint32_t m_tick = 0;
  Focus m_focus;
  CompactRect m_window;  ///< m_focus.window
  CellRect m_seen;       ///< the window of the update before: whoever was in it is known
  CellRect m_searched;   ///< the window at the last search
  CellRect m_covered;  ///< the candidates are all that may enter a window inside this before the next search
  bool m_began = false;
  std::vector<std::uint32_t> m_candidates;  ///< slots
  SlotBits m_known_bits;
  struct Stay {
    std::uint32_t until = 0;                     ///< the tick until which it cannot leave m_searched
    std::uint32_t slot = KnownObjects::kNobody;  ///< of who is known under the id
  };
  std::vector<Stay> m_stays;  ///< by id
};

}  // namespace naiad
