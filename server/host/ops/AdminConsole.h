// Carries out commands, wherever they come from: the control socket, or the chat of an admin.
#pragma once

#include <functional>
#include <string>

#include "host/admin/AdminCaller.h"
#include "host/admin/AdminWorker.h"
#include "host/admin/BanList.h"
#include "host/ops/HostAdmin.h"
#include "host/rooms/HostContext.h"
#include "shared/admin/AdminRequest.h"

namespace naiad {

/// On the host's thread. Each command of an admin is logged with who gave it, passwords as "***".
class AdminConsole {
 public:
  using Done = std::function<void(AdminAnswer)>;

  /// All of these outlive it.
  AdminConsole(HostContext& context, HostAdmin& admin, AdminWorker& worker, BanList& bans)
      : m_context(context), m_admin(admin), m_worker(worker), m_bans(bans) {}

  /// `done` is called once, on the host's thread: now, or later for what takes long.
  void execute(const AdminRequest& request, const AdminCaller& caller, Done done);

 private:
  AdminAnswer answerNow(const AdminRequest& request, const AdminCaller& caller);
  void changePassword(const AdminRequest& request, Done done);
  void reload(Done done);
  void scores(const AdminRequest& request, Done done);
  void answerSaved(const std::string& text, const std::string& problem, const Done& done);
  AdminAnswer listRooms() const;
  AdminAnswer listPlayers(const AdminCaller& caller) const;
  AdminAnswer tell(const AdminRequest& request, const AdminCaller& caller);
  AdminAnswer kick(const AdminRequest& request);
  AdminAnswer mute(const AdminRequest& request, bool muted);
  AdminAnswer restart(const AdminRequest& request);
  AdminAnswer set(const AdminRequest& request);
  void ban(const AdminRequest& request, const AdminCaller& caller, const Done& done);
  void unban(const AdminRequest& request, const Done& done);
  AdminAnswer listBans() const;
  void endBanned();

  void post(std::function<void()> job);

  HostContext& m_context;
  HostAdmin& m_admin;
  AdminWorker& m_worker;
  BanList& m_bans;
};

}  // namespace naiad
