// Lines of chat that begin with /: commands of players and admins.
#pragma once

#include <asio/any_io_executor.hpp>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "host/admin/AdminConsole.h"
#include "host/admin/VoteKick.h"
#include "host/auth/PasswordCheck.h"
#include "host/rooms/SessionTable.h"
#include "host/settings/HostOptions.h"
#include "shared/admin/AdminRequest.h"

namespace naiad {

/// Such a line reaches nobody but the server, whatever is in it: a password may be, after /admin or after a
/// slip of the finger. On the host's thread.
class ChatCommands {
 public:
  /// Lines that one answer takes, at most.
  static constexpr std::size_t kMaxLines = 30;

  /// What it works with; all of it outlives this.
  struct Setup {
    const HostOptions& options;
    const SessionTable& sessions;
    AdminTarget& target;
    AdminConsole& console;
    BanList& bans;
    /// Log what a client did, and what was refused to it.
    std::function<void(const std::string& address, const std::string& text)> log_client;
    std::function<void(const std::string& address, const std::string& text)> log_refusal;
  };
  /// `executor` runs what is left once a password has been checked. Throws PasswordError.
  ChatCommands(Setup setup, const asio::any_io_executor& executor);

  /// Is it a command? `line` is clean (cleanChat). Blanks in front do not matter, nor characters that cannot
  /// be drawn, which are question marks by now: a password after one of them must not reach others.
  static bool isCommand(const std::string& line);
  void serve(Session& session, const std::string& line);
  /// Votes that failed. Once a tick.
  void update(Session::Clock::time_point now);

 private:
  void execute(Session& session, const AdminRequest& request);
  void help(Session& session, const AdminRequest& request);
  void becomeAdmin(Session& session, const std::string& password);
  void onPassword(std::uint64_t id, std::uint32_t streams, PasswordCheck::Answer answer);
  void vote(Session& session, const AdminRequest& request);
  void throwOut(const AdminPlayer& player);
  void reply(Session& session, const std::vector<std::string>& lines);

  Setup m_setup;
  std::unique_ptr<PasswordCheck> m_password;  ///< null: there are no admins in the chat
  VoteKick m_vote;
};

}  // namespace naiad
