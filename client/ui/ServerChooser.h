// Shows a full-screen list of servers on a real terminal until the player chooses one: servers of the local
// network, which is searched continuously, or of a list that is fetched.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "client/lan/DiscoveredServers.h"
#include "client/lan/LanBrowser.h"
#include "client/lan/ListDownload.h"
#include "client/terminal/InputDecoder.h"
#include "client/terminal/TerminalType.h"
#include "client/ui/ServerMenu.h"

namespace naiad {

class Screen;
class TerminalGuard;

class ServerChooser {
 public:
  struct Options {
    TerminalType terminal;
    bool ascii = false;
    bool colors = true;
    /// Fetches a list; keys typed until it returns are handled then. Empty: show the local network's servers.
    std::function<std::variant<DiscoveredServers, DownloadError>()> fetch{};
  };
  struct Outcome {
    std::optional<DiscoveredServer> server;  ///< nullopt: the player left, or a signal came
    int signal = 0;                          ///< signal that ended the chooser, to be raised again; 0: none
  };

  explicit ServerChooser(Options options);
  ~ServerChooser();

  /// Shows the list, then restores the terminal. Throws std::runtime_error if it cannot draw on the terminal.
  Outcome run();

 private:
  using Time = std::chrono::steady_clock::time_point;

  void acquireTerminal();
  void wait();
  void readKeys(Time now);
  void handleEvents(const std::vector<TerminalEvent>& events, Time now);
  void handleSignals();
  void refresh(Time now);
  void fetch();
  void receiveAnswers(Time now);
  void suspend();
  void draw();

  Options m_options;
  std::optional<LanBrowser> m_browser;  ///< nullopt with Options::fetch
  ServerMenu m_menu;
  InputDecoder m_decoder;
  std::unique_ptr<TerminalGuard> m_guard;
  std::unique_ptr<Screen> m_screen;
  Outcome m_outcome;
  Time m_begun{};  ///< start of the search
  bool m_searching = true;
  bool m_dirty = true;
  bool m_done = false;
};

}  // namespace naiad
