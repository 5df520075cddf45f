// The client in a browser: what ClientApp is in a terminal. The page gives it keys, pointer and messages, and
// draws its picture.
//
// Everything but the page is the same as in dfclient: session, replica, prediction, controls, layout. Time is
// a parameter; nothing here waits.
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
#include "client/ui/SoundNotes.h"
#include "client/web/BrowserKeys.h"
#include "client/web/WebStreams.h"

namespace naiad {

/// The token of the session that a browser's tab plays, kept by its page.
/// There is one server, the one behind the gateway, so its key is not looked at. Not thread-safe.
class TabTokens : public TokenStore {
 public:
  /// `kept`: what the page kept for this tab, hexadecimal; anything else counts as nothing.
  TabTokens(WebPort& port, std::string_view kept);

  std::string tokenFor(const Fingerprint&) const override { return m_token; }
  void save(SavedSession session, Time now) override;
  void refresh(Time) override {}
  void remove() override;

 private:
  WebPort& m_port;
  std::string m_token;
};

class WebClient {
 public:
  using Time = std::chrono::steady_clock::time_point;

  struct Options {
    std::string name;
    std::string password;
    std::string token;    ///< what the page kept for this tab
    std::string program;  ///< for the server's log
    std::string server;   ///< what the page calls the server
    std::string room;     ///< of the page's address, to begin in; what is no name of one counts as none
    int columns = 0;      ///< of the picture, in cells
    int rows = 0;
  };
  enum class State : int { kJoining, kPlaying, kRefused, kOver, kLeft };

  /// Joins immediately. `port` must outlive it.
  WebClient(WebPort& port, const Options& options, Time now);

  /// The page reports there what becomes of streams.
  WebStreams& streams() { return *m_p_streams; }

  void pressKey(std::string_view key, std::string_view code, KeyEvent::Action action, std::uint8_t modifiers,
                Time now);
  /// `x`, `y`: cell of the picture.
  void moveMouse(const MouseEvent& event, Time now) { m_player.moveMouse(event, m_layout.placement, now); }
  /// A command of the client, by its letter (ClientControls): t, p, h, s, q.
  void command(char32_t letter, Time now);
  /// What the text field of the page holds while a line of chat is written.
  void setChatText(std::string_view text) { m_controls.setChatText(text); }
  bool isChatOpen() const { return m_controls.chatOpen(); }
  /// The page has lost the keyboard: no key is down.
  void releaseKeys(Time now);
  /// The picture has another size, in cells; clamped to 1 … 400 by 1 … 150.
  void resize(int columns, int rows);

  /// Time-outs, held keys, sounds. Call at least ten times a second, and after every message.
  void update(Time now);
  /// Compose the picture if it would differ from the last one. True if it was.
  bool compose(Time now);
  /// The newest picture.
  const Picture& picture() const { return m_layout.picture; }

  State state() const;
  /// Why it is not playing, for people; empty if there is nothing to say.
  std::string sentence() const;
  /// The game's view, in cells; 80 by 24 before it is known.
  int viewWidth() const { return m_view_width; }
  int viewHeight() const { return m_view_height; }
  /// For recorders, before the first message.
  Connection& connection() { return m_connection; }

 private:
  void takeKey(const KeyEvent& event, Time now);

  WebPort& m_port;
  int m_columns;
  int m_rows;
  TabTokens m_tokens;
  WebStreams* m_p_streams;  ///< the connection's
  Connection m_connection;
  BrowserKeys m_keys;
  ClientControls m_controls;
  SoundNotes m_sounds{SoundMode::kNote};
  PlayerInput m_player{m_connection};
  FrameComposer m_composer{m_connection, m_controls, m_sounds};
  ScreenLayout m_layout;
  int m_view_width = 80;
  int m_view_height = 24;
  bool m_dirty = true;
};

}  // namespace naiad
