// Interest management: the objects in one client's view and those about to enter it.
//
// Objects are re-examined only when they may have entered or left the view. The path of a model is known
// until the model changes, so between changes:
//
//   in      a changed object is judged at once. Every kGap ticks the blocks around the view are searched for
//           candidates, which may enter it before the next search; only these few are judged in each tick.
//           Blocks inside the view hold no object that is unknown.
//   out     the same search examines those known objects whose straight path may have led out by now. To
//           remove an object late costs little.
//
// The search covers some cells more than a moving view, and is repeated at once when these are used up.
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
  /// To be called after every update of the publisher: births, deaths and changes become pending in `known`.
  void update(const Publisher& publisher, const Focus& focus, KnownObjects& known);

  /// Is the object in the view, or will it be after `look_ahead` ticks?
  static bool isVisible(const Publisher::Model& model, std::uint32_t tick, std::uint32_t look_ahead,
                        const CellRect& window);

  /// Ticks between two searches.
  static constexpr std::uint32_t kGap = 8;
  /// An object that left the view is removed only this many cells outside, so that it does not come and go at
  /// the edge.
  static constexpr std::int64_t kHysteresis = 2;

 private:
  /// Cells to spare around a view that moves.
  static constexpr std::int64_t kSpare = 4;

  using Changes = std::array<const Publisher::Change*, 32>;
  void noteChanges();
  void markChanges(ChangeIndex::Marks& marks) const;
  void noteChanges(const Changes& changes, std::size_t count);
  void noteChange(const Publisher::Change& change, std::uint32_t id);
  void considerObject(std::uint32_t slot);
  void judgeCandidates();
  bool isSearchDue() const;
  void searchView();
  void removeOutside(const CellRect& outer, bool moves);
  bool isOwn(std::uint32_t id, std::uint32_t slot) const;
  std::uint32_t leavesAfter(const Publisher::Model& model, const CellRect& outer) const;
  void addObject(std::uint32_t slot, std::uint32_t generation);
  const Publisher::Outlook& outlook(std::uint32_t slot) const {
    return m_p_publisher->outlook(slot, m_focus.look_ahead, kGap + m_focus.look_ahead);
  }
  // Most changes in the world concern objects that the client does not know. A bit for each slot, modulo
  // their count, tells so without a lookup in the table. In a world of fewer slots the bits are exact; the
  // last one is of kLooseSlot.
  static_assert(kLooseSlot % SlotBits::kBits == SlotBits::kBits - 1);
  bool bitsAreExact() const { return m_p_publisher->slotCount() < SlotBits::kBits; }
  bool mayBeKnown(std::uint32_t slot) const { return m_known_bits.has(slot); }
  bool isKnown(std::uint32_t slot) const {
    return mayBeKnown(slot) && (bitsAreExact() || m_p_known->find(slot) != KnownObjects::kNone);
  }
  void removeObject(std::uint32_t id, std::uint32_t slot);

  const Publisher* m_p_publisher = nullptr;  ///< these three only during update()
  KnownObjects* m_p_known = nullptr;
  std::uint32_t m_tick = 0;
  Focus m_focus;
  CompactRect m_window;    ///< m_focus.window
  CellRect m_last_window;  ///< the window of the update before: all objects in it are known
  CellRect m_searched;     ///< the window at the last search
  CellRect m_covered;  ///< the candidates are all that may enter a window inside this before the next search
  bool m_has_searched = false;
  std::vector<std::uint32_t> m_candidates;  ///< slots
  SlotBits m_known_bits;
  struct Stay {
    std::uint32_t until = 0;                   ///< the tick until which it cannot leave m_searched
    std::uint32_t slot = KnownObjects::kNone;  ///< of the object with the id
  };
  std::vector<Stay> m_stays;  ///< by id
};

}  // namespace naiad
