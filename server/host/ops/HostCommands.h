// Takes commands for a host: from the socket for programs of this machine, and from the chat.
#pragma once

#include <asio/io_context.hpp>
#include <memory>
#include <string>

#include "host/admin/AdminConsole.h"
#include "host/admin/AdminWorker.h"
#include "host/admin/BanList.h"
#include "host/admin/ControlSocket.h"
#include "host/admin/WatchFeed.h"
#include "host/ops/ChatCommands.h"
#include "host/ops/HostAdmin.h"
#include "shared/program/ClientLog.h"

namespace naiad {

/// On the host's thread, where commands are carried out, too.
class HostCommands {
 public:
  /// What it works with; all of it outlives this.
  struct Setup {
    HostAdmin::Setup host;
    BanList& bans;
    AdminWorker& worker;
    WatchFeed& feed;  ///< what those who watch see
    ClientLog& client_log;
    LogLine log;
  };
  /// `home` runs what is carried out later. Throws PasswordError.
  HostCommands(Setup setup, asio::io_context& home);
  /// Closes.
  ~HostCommands();
  HostCommands(const HostCommands&) = delete;
  HostCommands& operator=(const HostCommands&) = delete;

  /// Make the socket, by HostOptions::control. Throws ListenError where that path was asked for and cannot
  /// be; the usual one is a convenience, without which a server goes on.
  void listen();
  /// Of the socket; empty: there is none.
  const std::string& path() const { return m_path; }

  /// `line` of the chat is a command (ChatCommands::isCommand).
  void serveChat(Session& session, const std::string& line) { m_chat.serve(session, line); }
  /// Once a tick.
  void update(Session::Clock::time_point now) { m_chat.update(now); }
  /// Take no more. What was promised is written before.
  void close();

 private:
  ChatCommands::Setup chatSetup();
  ControlListening listening(bool by_default) const;
  ControlSocket::Execute executor();

  Setup m_setup;
  asio::io_context& m_home;
  HostAdmin m_admin;
  AdminConsole m_console;
  ChatCommands m_chat;
  std::string m_path;
  std::unique_ptr<ControlSocket> m_control;  ///< null: there is none
};

}  // namespace naiad
