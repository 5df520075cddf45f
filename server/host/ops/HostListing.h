// Lets players find a server: in the local network, and by a file for lists on the web.
#pragma once

#include <memory>

#include "host/loop/HostPart.h"
#include "host/net/LanResponder.h"
#include "host/ops/StatusFile.h"

namespace naiad {

/// On the host's thread.
class HostListing : public HostPart {
 public:
  /// By the options. Throws ListenError with HostOptions::lan "on" if there is no socket for the network's
  /// queries, and std::runtime_error for a status file that cannot be written.
  explicit HostListing(const HostAccess& access);

  /// It answers in the local network from now on.
  void begin() override;
  /// The number of players is told on.
  void tick(Clock::time_point now) override;
  /// It is found no more.
  void drain() override;
  /// What became of the network's queries goes to the log.
  void finish() override;

 private:
  std::unique_ptr<LanResponder> openLan() const;
  std::unique_ptr<StatusFile> openStatus() const;

  HostAccess m_access;
  std::unique_ptr<LanResponder> m_lan;   ///< null: not to be found in the local network
  std::unique_ptr<StatusFile> m_status;  ///< null: none is asked for
};

}  // namespace naiad
