// Commands that players and admins type in the chat: lines that begin with /.
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

/// Thread: the host's.
class ChatCommands {
 public:
  /// Maximum number of lines of an answer.
  static constexpr std::size_t kMaxLines = 30;

  /// All arguments must outlive it. Throws PasswordError.
  ChatCommands(const HostAccess& access, HostAdmin& admin, AdminConsole& console, BanList& bans);

  void serve(Session& session, const std::string& line);
  /// Announces votes that failed because their time is over. Call it once a tick.
  void update(Session::Clock::time_point now);

 private:
  void execute(Session& session, const AdminRequest& request);
  void help(Session& session, const AdminRequest& request);
  void becomeAdmin(Session& session, const std::string& password);
  void onPassword(std::uint64_t id, std::uint32_t streams, PasswordCheck::Answer answer);
  void vote(Session& session, const AdminRequest& request);
  void kickByVote(const AdminPlayer& player);
  void reply(Session& session, const std::vector<std::string>& lines);

  void logClientEvent(const Session& session, const std::string& text);
  void refuse(Session& session, const std::string& sentence);

  HostAccess m_access;
  HostAdmin& m_admin;
  AdminConsole& m_console;
  BanList& m_bans;
  std::unique_ptr<PasswordCheck> m_password;  ///< null: no admins in the chat
  VoteKick m_vote;
};

}  // namespace naiad
