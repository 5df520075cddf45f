// Lines of chat that begin with /: commands of players and admins.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "host/admin/VoteKick.h"
#include "host/auth/PasswordCheck.h"
#include "host/loop/HostPart.h"
#include "host/ops/AdminConsole.h"
#include "host/session/Session.h"
#include "shared/admin/AdminRequest.h"

namespace naiad {

/// On the host's thread.
class ChatCommands {
 public:
  /// Lines that one answer takes, at most.
  static constexpr std::size_t kMaxLines = 30;

  /// What it works with outlives it. Throws PasswordError.
  ChatCommands(const HostAccess& access, HostAdmin& admin, AdminConsole& console, BanList& bans);

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

  void logNews(const Session& session, const std::string& text);
  void refuse(Session& session, const std::string& sentence);

  HostAccess m_access;
  HostAdmin& m_admin;
  AdminConsole& m_console;
  BanList& m_bans;
  std::unique_ptr<PasswordCheck> m_password;  ///< null: there are no admins in the chat
  VoteKick m_vote;
};

}  // namespace naiad
