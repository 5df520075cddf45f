// A world that makes copies, and its keeper's part in what follows when it ends: the front says which copy is
// the world from then on, and all other descendants of the keeper end.
#pragma once

#include <sys/types.h>

#include "host/world/WorldLauncher.h"

namespace naiad {

class Succession {
 public:
  /// How long a keeper waits for the front's word after a world's end.
  static constexpr int kWordMillis = 1'000;

  /// `world`: a child of this process, which has no threads and is a child subreaper. `front`: the keeper's
  /// socket. `children`: readable when one has ended.
  Succession(pid_t world, int front, int children) : m_world(world), m_front(front), m_children(children) {}

  /// Until the front wants no world any more, or has gone. Each end of a world is reported but the last one.
  /// Return the world that is left; 0: it has ended, and m_status says how.
  pid_t run();
  /// Of the last world that has ended, as of waitpid().
  int status() const { return m_status; }

 private:
  bool waitForEnd();
  bool takeOrder(KeeperOrder& order) const;
  bool waitForWord(KeeperOrder& order) const;
  bool report(KeeperEnd::Kind what) const;

  pid_t m_world;
  const int m_front;
  const int m_children;
  int m_status = 0;
};

}  // namespace naiad
