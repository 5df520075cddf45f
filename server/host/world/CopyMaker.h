// In a world's process: makes copies of it, as the front orders (WorldCopies.h).
//
// A copy waits on a socket of its own until the front lets it go on in place of the world, and ends when that
// socket closes. It is a child of the world's keeper, not of the world: the game's own wait() never sees it,
// and it ends with the keeper as the world does.
#pragma once

#include <optional>

namespace naiad {

class CopyMaker {
 public:
  /// Takes over kWorldCopies, if this process has it; without it no copies are made.
  CopyMaker();
  ~CopyMaker();
  CopyMaker(const CopyMaker&) = delete;
  CopyMaker& operator=(const CopyMaker&) = delete;

  /// Make the copy that was ordered last. For a process without threads, between two turns. Return in the
  /// world: nothing, at once, whether or not there is a copy. Return in the copy: its end of the socket, on
  /// which the front has sent the next turn; `world_socket` is closed there.
  std::optional<int> makeCopy(int world_socket) const;

 private:
  int takeOrder() const;

  int m_orders = -1;
};

}  // namespace naiad
