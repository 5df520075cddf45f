// The list of servers on the screen: which one is chosen, what a key does, and how it looks.
//
// Neither a terminal nor a clock: ServerChooser has both.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "client/lan/FoundServers.h"
#include "client/terminal/InputDecoder.h"
#include "client/terminal/Picture.h"

namespace naiad {

class ServerMenu {
 public:
  /// What the program must do about a key.
  enum class Result { kNone, kRedraw, kJoin, kRefresh, kLeave, kSuspend };

  /// `title`: where the servers were found.
  explicit ServerMenu(std::string title) : m_title(std::move(title)) {}

  /// Show these sentences where there is no server.
  void setEmpty(std::vector<std::string> empty) { m_empty = std::move(empty); }
  /// Show these. The chosen one stays chosen, wherever it is now; the first one is at first.
  void setServers(std::vector<FoundServer> servers);
  /// Answers may still come: an empty list is none to speak of yet.
  void setLooking(bool looking) { m_looking = looking; }
  /// Arrows (or j and k), Page Up and Down, Home and End choose; Enter joins, r refreshes, q, Esc and Ctrl-C
  /// leave.
  Result takeKey(const KeyEvent& event);
  /// Null while there is none.
  const FoundServer* chosen() const;
  /// On a terminal of `columns` by `rows` cells.
  Picture compose(int columns, int rows);

 private:
  Result choose(int index);
  Result joinChosen();
  void writeRow(Picture& picture, int y, const FoundServer& server, bool is_chosen) const;
  void writeEmpty(Picture& picture) const;

  std::string m_title;
  std::vector<std::string> m_empty;
  std::vector<FoundServer> m_servers;
  int m_chosen = 0;
  int m_first = 0;  ///< server in the uppermost row
  int m_page = 1;   ///< rows of servers in the last picture
  bool m_looking = true;
  std::string m_message;  ///< why the chosen one cannot be joined; else empty
};

}  // namespace naiad
