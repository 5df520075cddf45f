#include "shared/replica/Acks.h"

namespace naiad {

void AckWindow::addReceived(std::uint32_t number) {
  if (newest == 0) {  // the first one; may be any number after a resumed session
    newest = number;
    return;
  }
  const auto ahead = static_cast<std::int32_t>(number - newest);
  if (ahead == 0) return;
  if (ahead > 0) {
    mask = ahead >= 64 ? 0 : mask << ahead;
    if (ahead <= 64) mask |= std::uint64_t{1} << (ahead - 1);
    newest = number;
  } else if (ahead >= -64) {
    mask |= std::uint64_t{1} << (-ahead - 1);
  }
}

bool AckWindow::has(std::uint32_t number) const {
  if (newest == 0 && mask == 0) return false;
  const auto behind = static_cast<std::int32_t>(newest - number);
  if (behind == 0) return true;
  return behind > 0 && behind <= 64 && ((mask >> (behind - 1)) & 1) != 0;
}

}  // namespace naiad
