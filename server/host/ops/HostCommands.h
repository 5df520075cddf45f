// Takes commands for a host: from the socket for programs of this machine, and from the chat.
#pragma once

#include <memory>

#include "host/admin/AdminWorker.h"
#include "host/admin/BanList.h"
#include "host/admin/ControlSocket.h"
#include "host/loop/HostPart.h"
#include "host/ops/AdminConsole.h"
#include "host/ops/ChatCommands.h"
#include "host/ops/HostAdmin.h"

namespace naiad {

/// On the host's thread, where commands are carried out, too.
class HostCommands : public HostPart {
 public:
  /// Makes the socket, by HostOptions::control, and has clients that are banned kept out. Throws
  /// BanFileError, PasswordError, and ListenError where the socket's path was asked for and cannot be; the
  /// usual one is a convenience, without which a server goes on.
  HostCommands(const HostAccess& access, HostScores& scores);
  /// As finish().
  ~HostCommands() override;
  HostCommands(const HostCommands&) = delete;
  HostCommands& operator=(const HostCommands&) = delete;

  void tick(Clock::time_point now) override { m_chat.update(now); }
  /// No more commands are taken. What was promised is written before.
  void finish() override;

 private:
  void listen();
  ControlListening listening(bool by_default) const;
  ControlSocket::Execute executor();

  HostAccess m_access;
  AdminWorker m_worker;
  BanList m_bans;  ///< the network thread asks it, too
  HostAdmin m_admin;
  AdminConsole m_console;
  ChatCommands m_chat;
  std::unique_ptr<ControlSocket> m_control;  ///< null: there is none
};

}  // namespace naiad
