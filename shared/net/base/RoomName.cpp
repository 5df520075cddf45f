#include "shared/net/base/RoomName.h"

#include <algorithm>

namespace naiad {
namespace {

bool isLetterOrDigit(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
}

}  // namespace

bool isRoomName(std::string_view name) {
  return !name.empty() && name.size() <= kMaxRoomName && isLetterOrDigit(name.front()) &&
         std::all_of(name.begin(), name.end(),
                     [](char c) { return isLetterOrDigit(c) || c == '-' || c == '_' || c == '.'; });
}

}  // namespace naiad
