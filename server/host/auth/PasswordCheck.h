// Checks the server's password without blocking the caller.
//
// A guess costs 64 MiB and 0.1 s by design, so it is made on a thread of its own, one at a time, from a short
// queue (PasswordQueue.h), and LoginRateLimit counts the wrong ones. What cannot be a password is wrong
// without either.
#pragma once

#include <asio/any_io_executor.hpp>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "host/auth/PasswordHash.h"
#include "shared/net/base/AddressPrefix.h"

namespace naiad {

/// Thread: that of `owner`, but for the worker inside. May be destroyed at any time, in its own callback too;
/// that waits for the guess that is being made, and no callback comes after it.
class PasswordCheck {
 public:
  enum class Answer {
    kRight,
    kWrong,
    kTooMany,  ///< This address was wrong too often lately; nothing was compared.
    kBusy,     ///< Too many at once; nothing was compared, or counted. Worth another try in a second.
  };
  struct Limits {
    std::size_t queue = 8;            ///< guesses that wait or are being made; two or more
    int wrong_per_window = 5;         ///< from one IPv4 address or IPv6 /64; right ones do not count
    std::chrono::seconds window{60};  ///< from the first wrong one
    std::size_t prefixes = 1024;      ///< remembered at once; then the least recently used is forgotten
  };
  struct Counters {
    std::uint64_t right = 0, wrong = 0, unfit = 0, too_many = 0, busy = 0;
  };

  /// `owner`: runs the callbacks; all members are called from there; must outlive this.
  PasswordCheck(asio::any_io_executor owner, PasswordHash hash, Limits limits);
  PasswordCheck(asio::any_io_executor owner, PasswordHash hash)
      : PasswordCheck(std::move(owner), std::move(hash), Limits{}) {}
  ~PasswordCheck();

  /// `from`: the client's address; `known`: it has players. `done` is called once, posted to the owner, never
  /// from inside. An empty password, or one of more than kMaxPassword bytes, is kWrong at once, and no guess.
  void check(const AddressPrefix& from, bool known, std::string password,
             std::chrono::steady_clock::time_point now, std::function<void(Answer)> done);

  /// Compare with this one from now on: guesses that wait, too. Never waits for a guess.
  void setHash(PasswordHash hash);

  const Counters& counters() const;
  /// Prefixes remembered.
  std::size_t remembered() const;

 private:
  struct State;
  class Worker;
  std::unique_ptr<Worker> worker_;
  std::shared_ptr<State> state_;  // uses the worker
};

}  // namespace naiad
