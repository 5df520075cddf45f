// The copies of a world's process, as the front has them: which there are, and where they are in the round.
//
// The front orders a copy by one end of a new pair of sockets, which it sends over a socket beside the
// world's, before the turn behind which the copy is to be made (WorldTurn::copied). So a world never has to
// make a socket. The copy writes its process id, and waits (CopyMaker). Two are kept, for the newer one may
// be sick already.
//
// A world may be a stranger's program: what it says of a copy is not believed (the keeper lets only a child
// of its own go on), and one that makes none is soon not asked any more.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/world/WorldView.h"
#include "host/world/ViewCodec.h"

namespace naiad {

/// Where a world was: answers are differences to what was sent before.
struct CopiedState {
  std::uint32_t next_tick = 1;  ///< by the host's numbers
  ViewReader views;
  df::WorldView view;
};

struct WorldCopy {
  int socket = -1;     ///< our end of its socket; whoever has this closes it
  pid_t process = -1;  ///< as it says; below 0: it has not yet
  CopiedState state;
};

class WorldCopies {
 public:
  static constexpr std::size_t kKept = 2;
  /// Orders in a row without a copy, and there are no more.
  static constexpr int kMaxFailures = 3;

  /// `orders`: our end of the socket beside the world's, which this closes; below 0: no copies.
  explicit WorldCopies(int orders) : m_orders(orders) {}
  /// All copies that have not been taken end.
  ~WorldCopies();
  WorldCopies(const WorldCopies&) = delete;
  WorldCopies& operator=(const WorldCopies&) = delete;

  /// Can any be ordered?
  bool isOn() const { return m_orders >= 0; }
  /// Why not any more, once, in words.
  std::optional<std::string> takeProblem() { return std::exchange(m_problem, std::nullopt); }

  /// Order one of `world`, a process, for the turn that is sent next. False: there is to be none.
  bool order(pid_t world);
  /// The world has answered that turn, and was so then.
  void add(CopiedState state);
  /// Read what copies say. Once in each tick.
  void update();
  /// The newest, for the one that lets it go on; nothing: there is none. It is not kept any more.
  std::optional<WorldCopy> takeNewest();
  /// Is there one that could go on?
  bool hasCopy() const { return !processes().empty(); }
  /// All copies end; more can be ordered.
  void clear();
  /// Those that are kept.
  std::vector<pid_t> processes() const;

 private:
  bool send(int descriptor) const;
  void stop();
  void drop(std::size_t at);
  void dropOrdered();
  bool hear(WorldCopy& copy);

  int m_orders;
  int m_ordered = -1;  ///< our end for the copy of the turn that is under way
  int m_failures = 0;
  std::vector<WorldCopy> m_copies;  ///< newest last
  std::optional<std::string> m_problem;
};

}  // namespace naiad
