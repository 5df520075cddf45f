// ClientApp's counterpart in a browser. The page passes keys, pointer and messages, and draws the picture.
//
// Session, replica, prediction, controls and layout are those of dfclient. The caller passes the time, but
// Connection also reads the clock. Nothing here blocks.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "client/session/Connection.h"
#include "client/trust/TokenStore.h"
#include "client/ui/ClientControls.h"
#include "client/ui/FrameComposer.h"
#include "client/ui/PlayerInput.h"
#include "client/ui/SoundIndicator.h"
#include "client/web/BrowserKeys.h"
#include "client/web/WebStreamOpener.h"

namespace naiad {

/// Stores the token of a browser tab's session in the page. The only server is the one behind the gateway, so
/// the servers' keys are ignored. Not thread-safe.
class TabTokenStore : public TokenStore {
 public:
  /// `kept`: the token that the page stored for this tab, hexadecimal; an invalid one counts as empty.
  TabTokenStore(PageBridge& port, std::string_view kept);

  std::string tokenFor(const Fingerprint&) const override { return m_token; }
  void save(SavedSession session, Time now) override;
  void refresh(Time) override {}
  void remove() override;

 private:
  PageBridge& m_port;
  std::string m_token;
};

class WebClient {
 public:
  using Time = std::chrono::steady_clock::time_point;

  struct Options {
    std::string name;
    std::string password;
    std::string token;    ///< stored by the page for this tab
    std::string program;  ///< name and version for the server's log
    std::string server;   ///< the server's name in the page
    std::string room;     ///< first room, from the page's address; an invalid name counts as empty
    int columns = 0;      ///< size of the picture in cells
    int rows = 0;
  };
  enum class State : int { kJoining, kPlaying, kRefused, kOver, kLeft };

  /// Joins immediately. `port` must outlive this.
  WebClient(PageBridge& port, const Options& options, Time now);

  /// Returns the opener to which the page must report the events of streams.
  WebStreamOpener& streams() { return *m_p_streams; }

  void pressKey(std::string_view key, std::string_view code, KeyEvent::Action action, std::uint8_t modifiers,
                Time now);
  /// `x`, `y`: cell of the picture.
  void moveMouse(const MouseEvent& event, Time now) { m_player.moveMouse(event, m_layout.placement, now); }
  /// Runs a command of the client by its letter (kBrowserKeyHelp): t, p, r, h, s, q.
  void command(char32_t letter, Time now);
  /// Sets an open chat line to the contents of the page's text field.
  void setChatText(std::string_view text) { m_controls.setChatText(text); }
  bool isChatOpen() const { return m_controls.isChatOpen(); }
  /// Call when the page has lost the keyboard: releases all keys.
  void releaseKeys(Time now);
  /// Sets the size of the picture in cells, clamped to 1 … 400 by 1 … 150.
  void resize(int columns, int rows);

  /// Handles timeouts, held keys and sounds. Call at least ten times a second, and after every message.
  void update(Time now);
  /// Composes the picture if it would differ from the last one. Returns true if it was composed.
  bool compose(Time now);
  const ScreenBuffer& picture() const { return m_layout.picture; }

  State state() const;
  /// Returns why the client is not playing, for people; may be empty.
  std::string message() const;
  /// Size of the game's view in cells; 80 by 24 before it is known.
  int viewWidth() const { return m_view_width; }
  int viewHeight() const { return m_view_height; }
  /// Returns the connection, to which recorders attach before the first message.
  Connection& connection() { return m_connection; }

 private:
  void handleKey(const KeyEvent& event, Time now);

  PageBridge& m_port;
  int m_columns;
  int m_rows;
  TabTokenStore m_tokens;
  WebStreamOpener* m_p_streams;  ///< owned by m_connection
  Connection m_connection;
  BrowserKeys m_keys;
  ClientControls m_controls;
  SoundIndicator m_sounds{SoundMode::kNote};
  PlayerInput m_player{m_connection};
  FrameComposer m_composer{m_connection, m_controls, m_sounds};
  ScreenLayout m_layout;
  int m_view_width = 80;
  int m_view_height = 24;
  bool m_dirty = true;
};

}  // namespace naiad
