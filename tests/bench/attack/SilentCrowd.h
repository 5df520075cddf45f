// silent4, silent6: 256 connections that never say a word; one that is hung up on comes again.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "Attack.h"

namespace bench::attack {

class SilentCrowd : public Attack {
 public:
  /// 64 connections from each of these addresses to the address of the server.
  SilentCrowd(std::vector<std::string> sources, std::string server);
  ~SilentCrowd() override;

  void begin(const Target& target) override;
  void end() override;
  void addFindings(Findings& findings) override;

 private:
  class Mute;
  std::vector<std::string> m_sources;
  std::string m_server;
  std::vector<std::shared_ptr<Mute>> m_mutes;
  long long m_connects = 0;
};

}  // namespace bench::attack
