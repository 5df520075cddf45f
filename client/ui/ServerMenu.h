// Menu of servers: the chosen server, the handling of keys, and the picture.
//
// It uses neither a terminal nor a clock; ServerChooser does.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "client/lan/DiscoveredServers.h"
#include "client/terminal/InputDecoder.h"
#include "client/terminal/ScreenBuffer.h"

namespace naiad {

class ServerMenu {
 public:
  /// Action that the program must take for a key.
  enum class Result { kNone, kRedraw, kJoin, kRefresh, kLeave, kSuspend };

  /// `title`: heading that says where the servers were found.
  explicit ServerMenu(std::string title) : m_title(std::move(title)) {}

  /// Sets the sentences to show if there is no server.
  void setEmpty(std::vector<std::string> empty) { m_empty = std::move(empty); }
  /// Replaces the servers. The chosen one stays chosen if it is among them; otherwise the first is chosen.
  void setServers(std::vector<DiscoveredServer> servers);
  /// `searching`: the search is not over, so an empty list shows "Looking ..." instead of the sentences.
  void setSearching(bool searching) { m_searching = searching; }
  /// Arrows (or j and k), Page Up and Down, Home and End choose; Enter joins, r refreshes, q, Esc and Ctrl-C
  /// leave, Ctrl-Z suspends.
  Result handleKey(const KeyEvent& event);
  /// Returns the chosen server; null if the list is empty.
  const DiscoveredServer* chosen() const;
  /// Draws the menu for a terminal of `columns` by `rows` cells.
  ScreenBuffer compose(int columns, int rows);

 private:
  Result choose(int index);
  Result joinChosen();
  void writeRow(ScreenBuffer& picture, int y, const DiscoveredServer& server, bool is_chosen) const;
  void writeEmpty(ScreenBuffer& picture) const;

  std::string m_title;
  std::vector<std::string> m_empty;
  std::vector<DiscoveredServer> m_servers;
  int m_chosen = 0;
  int m_first = 0;  ///< index of the server in the top row
  int m_page = 1;   ///< number of rows for servers in the last picture
  bool m_searching = true;
  std::string m_message;  ///< set if the chosen server cannot be joined: the reason
};

}  // namespace naiad
