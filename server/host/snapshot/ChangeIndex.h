// Indexes the changes of a tick, so that thousands of clients each find the relevant ones quickly.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "host/snapshot/InterestGrid.h"

namespace naiad {

/// A set of slots with one bit per slot modulo kBits. has() may be true for slots that were not added.
class SlotBits {
 public:
  static constexpr std::uint32_t kBits = 4096;

  bool has(std::uint32_t slot) const { return (m_words[slot % kBits / 64] >> (slot % 64) & 1) != 0; }
  void set(std::uint32_t slot) { m_words[slot % kBits / 64] |= std::uint64_t{1} << (slot % 64); }
  void clear(std::uint32_t slot) { m_words[slot % kBits / 64] &= ~(std::uint64_t{1} << (slot % 64)); }
  void clear() { m_words = {}; }
  /// Calls `visit(bit)` for all bits that are set in both sets, in ascending order.
  template <class Visit>
  void forEachShared(const SlotBits& other, Visit visit) const {
    for (std::uint32_t i = 0; i < m_words.size(); ++i) {
      for (std::uint64_t left = m_words[i] & other.m_words[i]; left != 0; left &= left - 1) {
        visit(64 * i + static_cast<std::uint32_t>(std::countr_zero(left)));
      }
    }
  }

 private:
  std::array<std::uint64_t, kBits / 64> m_words{};
};

class ChangeIndex {
 public:
  /// One byte per change, by index: nonzero if it concerns the client. May end with additional zero bytes.
  using Marks = std::vector<std::uint8_t>;

  void clear() {
    m_slots.clear();
    for (auto* side : {&m_left, &m_top, &m_right, &m_bottom}) side->clear();
  }
  /// Adds the next change. `sweep`: where the object may be drawn; nowhere() if it is gone.
  void add(std::uint32_t slot, const CompactRect& sweep) {
    m_index[slot % SlotBits::kBits] = static_cast<std::uint32_t>(m_left.size());
    m_slots.set(slot);
    m_left.push_back(sweep.left);
    m_top.push_back(sweep.top);
    m_right.push_back(sweep.right);
    m_bottom.push_back(sweep.bottom);
  }

  /// Marks the changes whose sweeps overlap the rectangle, and no others.
  void markMeeting(CompactRect rect, Marks& marks) const {
    marks.assign((m_left.size() + 7) / 8 * 8, 0);
    const std::size_t count = m_left.size();
    const std::int32_t* __restrict const left = m_left.data();
    const std::int32_t* __restrict const top = m_top.data();
    const std::int32_t* __restrict const right = m_right.data();
    const std::int32_t* __restrict const bottom = m_bottom.data();
    std::uint8_t* __restrict const out = marks.data();
    for (std::size_t i = 0; i < count; ++i) {  // no branches, so that the compiler can vectorize the loop
      out[i] = static_cast<std::uint8_t>(
          static_cast<int>(left[i] < rect.right) & static_cast<int>(rect.left < right[i]) &
          static_cast<int>(top[i] < rect.bottom) & static_cast<int>(rect.top < bottom[i]));
    }
  }
  /// Also marks the changes of these slots. The bits of all slots of the world must differ.
  void markShared(const SlotBits& slots, Marks& marks) const {
    m_slots.forEachShared(slots, [&](std::uint32_t bit) { marks[m_index[bit]] = 1; });
  }
  /// Calls `visit(index)` for all marked changes, in order.
  template <class Visit>
  static void forEachMarked(const Marks& marks, Visit visit) {
    for (std::size_t i = 0; i < marks.size(); i += 8) {
      std::uint64_t eight = 0;
      std::memcpy(&eight, &marks[i], sizeof eight);
      if (eight == 0) continue;
      for (std::size_t k = i; k < i + 8; ++k) {
        if (marks[k] != 0) visit(k);
      }
    }
  }

 private:
  SlotBits m_slots;
  std::array<std::uint32_t, SlotBits::kBits> m_index{};  ///< index of the newest change with this bit
  std::vector<std::int32_t> m_left;
  std::vector<std::int32_t> m_top;
  std::vector<std::int32_t> m_right;
  std::vector<std::int32_t> m_bottom;
};

}  // namespace naiad
