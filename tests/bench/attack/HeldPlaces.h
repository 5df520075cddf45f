// held_places: one address joins and is killed, again and again, so that detached sessions hold places.
#pragma once

#include <memory>

#include "Attack.h"
#include "Guest.h"

namespace bench::attack {

class HeldPlaces : public Attack {
 public:
  /// What its players are called.
  static constexpr const char* kName = "held";
  static constexpr int kAllowed = 2;

  ServerSetup setup() const override;
  void begin(const Target& target) override;
  void update(Time now) override;
  void end() override;
  void addFindings(Findings& findings) override;

 private:
  asio::io_context* m_p_context = nullptr;
  std::uint16_t m_port = 0;
  std::unique_ptr<Guest> m_guest;
  Time m_next{};
  long long m_joined = 0;
  long long m_refused = 0;
};

}  // namespace bench::attack
