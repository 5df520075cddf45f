#include "shared/values/ControlTable.h"

#include <algorithm>

#include "shared/values/FixedRange.h"

namespace df {

namespace {

bool isValid(const ControlRow& row) {
  if (row.key < 0 || row.key >= Keyboard::kKeyCount) return false;
  if (row.action < KEY_PRESSED || row.action > KEY_DOWN) return false;
  if (row.effect > ControlEffect::kDrive) return false;
  if (row.effect == ControlEffect::kStep && !(row.x && row.y)) return false;
  if (row.effect == ControlEffect::kDrive && (row.action != KEY_PRESSED || row.wait != 0)) return false;
  if ((!row.x && row.value.x != 0) || (!row.y && row.value.y != 0)) return false;
  return isWithin(row.value, kMaxControlReach) && row.wait <= kMaxControlTicks && row.group < kControlGroups;
}

}  // namespace

bool isValid(const ControlTable& table) {
  constexpr Fixed kFar = fromCells(1'000'000);
  if (table.rows.size() > kMaxControlRows || table.patience > kMaxControlTicks) return false;
  const FixedBox& box = table.bounds;
  if (!table.bounded && box != FixedBox{}) return false;
  if (!isWithin(box.corner, kFar) || !isWithin(box.size, kFar) || box.size.x < 0 || box.size.y < 0) {
    return false;
  }
  return std::all_of(table.rows.begin(), table.rows.end(),
                     [](const ControlRow& row) { return isValid(row); });
}

}  // namespace df
