// Interest management: the objects in one client's view and those about to enter it.
//
// Objects are examined again only when they may have entered or left the view. The path of a model is known
// until the model changes, so between changes:
//
//   enter   A changed object is checked at once. Every kSearchInterval ticks the blocks around the view are
//           searched for candidates, which may enter it before the next search; only these few are checked in
//           each tick. Blocks inside the view contain no unknown objects.
//   leave   This search also examines the known objects that may have left the view; for a straight path the
//           first tick in which it may is computed. Removing an object late costs little.
//
// Around a moving view the search covers more cells. It is repeated at once when the view leaves these cells.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "host/snapshot/KnownObjects.h"
#include "host/snapshot/Publisher.h"

namespace naiad {

class Interest {
 public:
  /// The area and objects of interest to the client.
  struct Focus {
    CellRect window;                     ///< cells that the client may show now or within look_ahead ticks
    std::array<df::ObjectKey, 2> own{};  ///< objects that the client knows wherever they are
    std::uint32_t look_ahead = 0;        ///< an object is known this many ticks before it may enter
    std::uint32_t stagger = 0;           ///< any number; spreads the searches of clients over the ticks
  };
  /// Call after every update of the publisher. Births, deaths and changes become pending in `known`.
  void update(const Publisher& publisher, const Focus& focus, KnownObjects& known);

  /// True if the object is in `window`, or may enter it within `look_ahead` ticks; always for wide models.
  static bool isVisible(const Publisher::Model& model, std::uint32_t tick, std::uint32_t look_ahead,
                        const CellRect& window);

  /// Number of ticks from one search to the next.
  static constexpr std::uint32_t kSearchInterval = 8;
  /// Distance in cells outside the view at which an object is removed, so it does not flicker at the edge.
  static constexpr std::int64_t kHysteresis = 2;

 private:
  /// Width in cells of the margin that is searched in addition around a moving view.
  static constexpr std::int64_t kSearchMargin = 4;

  using Changes = std::array<const Publisher::Change*, 32>;
  void processChanges();
  void markChanges(ChangeIndex::Marks& marks) const;
  void processChanges(const Changes& changes, std::size_t count);
  void processChange(const Publisher::Change& change, std::uint32_t id);
  void considerObject(std::uint32_t slot);
  void checkCandidates();
  bool isSearchDue() const;
  void searchView();
  void removeOutside(const CellRect& outer, bool moves);
  bool isOwn(std::uint32_t id, std::uint32_t slot) const;
  std::uint32_t leavesAfter(const Publisher::Model& model, const CellRect& outer) const;
  void addObject(std::uint32_t slot, std::uint32_t generation);
  const Publisher::Forecast& forecast(std::uint32_t slot) const {
    return m_p_publisher->forecast(slot, m_focus.look_ahead, kSearchInterval + m_focus.look_ahead);
  }
  // Most changes in the world concern objects that the client does not know. m_known_bits shows this without
  // a table lookup. It is exact in a world of fewer slots than bits; the last bit belongs to kFreeDrawSlot.
  static_assert(kFreeDrawSlot % SlotBits::kBits == SlotBits::kBits - 1);
  bool bitsAreExact() const { return m_p_publisher->slotCount() < SlotBits::kBits; }
  bool mayBeKnown(std::uint32_t slot) const { return m_known_bits.has(slot); }
  bool isKnown(std::uint32_t slot) const {
    return mayBeKnown(slot) && (bitsAreExact() || m_p_known->find(slot) != KnownObjects::kNone);
  }
  void removeObject(std::uint32_t id, std::uint32_t slot);

  const Publisher* m_p_publisher = nullptr;  ///< this and the next two members are valid only during update()
  KnownObjects* m_p_known = nullptr;
  std::uint32_t m_tick = 0;
  Focus m_focus;
  CompactRect m_window;    ///< m_focus.window, in compact form
  CellRect m_last_window;  ///< window of the previous update(): all objects in it are known
  CellRect m_searched;     ///< the window at the last search
  CellRect m_covered;  ///< m_candidates has all unknown objects that may enter a window inside this rectangle
                       ///< before the next search
  bool m_has_searched = false;
  std::vector<std::uint32_t> m_candidates;  ///< slots of objects that may enter soon
  SlotBits m_known_bits;
  struct Stay {
    std::uint32_t until = 0;                   ///< tick before which the object need not be examined
    std::uint32_t slot = KnownObjects::kNone;  ///< slot of the object with this id
  };
  std::vector<Stay> m_stays;  ///< indexed by id
};

}  // namespace naiad
