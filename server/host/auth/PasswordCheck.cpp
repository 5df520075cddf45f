#include "host/auth/PasswordCheck.h"

#include <openssl/crypto.h>

#include <asio/execution/outstanding_work.hpp>
#include <asio/post.hpp>
#include <asio/prefer.hpp>
#include <condition_variable>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "host/auth/LoginRateLimit.h"

namespace naiad {
namespace {

/// A secret that is wiped when it is done with.
struct Secret {
  explicit Secret(std::string secret) : text(std::move(secret)) {}
  ~Secret() { OPENSSL_cleanse(text.data(), text.size()); }
  Secret(const Secret&) = delete;
  Secret& operator=(const Secret&) = delete;
  std::string text;
};

}  // namespace

/// The owner's side, with all callbacks: none is touched, copied or destroyed by the worker. What the worker
/// posts has a weak pointer to it, and does nothing after the end.
struct PasswordCheck::State {
  State(asio::any_io_executor executor, const Limits& with_limits)
      : owner(std::move(executor)),
        limits(with_limits),
        tries(limits.wrong_per_window, limits.window, limits.prefixes) {}

  asio::any_io_executor owner;
  Limits limits;
  LoginRateLimit tries;
  Counters counters;
  struct Pending {
    AddressPrefix from;
    std::function<void(Answer)> done;
  };
  std::map<std::uint64_t, Pending> pending;  // given to the worker, not answered
  std::uint64_t newest = 0;

  void onCompared(std::uint64_t number, std::optional<bool> right);
};

void PasswordCheck::State::onCompared(std::uint64_t number, std::optional<bool> right) {
  const auto job = pending.extract(number);
  const auto& [from, done] = job.mapped();
  tries.finishTry(from, right.value_or(true));
  ++(!right ? counters.busy : *right ? counters.right : counters.wrong);
  done(!right ? Answer::kBusy : *right ? Answer::kRight : Answer::kWrong);
}

/// The thread and its queue.
class PasswordCheck::Worker {
 public:
  struct Job {
    std::unique_ptr<Secret> password;
    /// Called on the worker's thread; nothing: no memory to compare.
    std::function<void(std::optional<bool> right)> report;
  };

  explicit Worker(PasswordHash hash) : hash_(std::move(hash)), thread_([this] { run(); }) {}
  ~Worker() {
    {
      const std::lock_guard lock(mutex_);
      stopping_ = true;
    }
    wake_.notify_one();
    thread_.join();
  }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  void give(Job job) {
    {
      const std::lock_guard lock(mutex_);
      jobs_.push_back(std::move(job));
    }
    wake_.notify_one();
  }

 private:
  void run() {
    std::unique_lock lock(mutex_);
    for (;;) {
      wake_.wait(lock, [this] { return stopping_ || !jobs_.empty(); });
      if (stopping_) return;
      const Job job = std::move(jobs_.front());
      jobs_.pop_front();
      lock.unlock();
      job.report(compare(job.password->text));
      lock.lock();
    }
  }
  std::optional<bool> compare(const std::string& password) const {
    try {
      return hash_.matches(password);
    } catch (const PasswordError&) {
      return std::nullopt;
    }
  }

  PasswordHash hash_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<Job> jobs_;
  bool stopping_ = false;
  std::thread thread_;  // last: it uses the others
};

PasswordCheck::PasswordCheck(asio::any_io_executor owner, PasswordHash hash, Limits limits)
    : state_(std::make_shared<State>(std::move(owner), limits)),
      worker_(std::make_unique<Worker>(std::move(hash))) {}

PasswordCheck::~PasswordCheck() {
  state_.reset();
}

void PasswordCheck::check(const AddressPrefix& from, std::string password,
                          std::chrono::steady_clock::time_point now, std::function<void(Answer)> done) {
  auto secret = std::make_unique<Secret>(std::move(password));
  const std::weak_ptr<State> weak = state_;
  const auto answer_later = [&](Answer answer) {
    asio::post(state_->owner, [weak, answer, call = std::move(done)] {
      if (!weak.expired()) call(answer);
    });
  };
  const bool full = state_->pending.size() >= state_->limits.queue;
  const auto allowed = full ? LoginRateLimit::Answer::kWait : state_->tries.beginTry(from, now);
  if (allowed == LoginRateLimit::Answer::kTooMany) {
    ++state_->counters.too_many;
    return answer_later(Answer::kTooMany);
  }
  if (allowed == LoginRateLimit::Answer::kWait) {
    ++state_->counters.busy;
    return answer_later(Answer::kBusy);
  }
  const std::uint64_t number = ++state_->newest;
  state_->pending.emplace(number, State::Pending{from, std::move(done)});
  // The owner's loop is not out of work while an answer is still to come.
  auto executor = asio::prefer(state_->owner, asio::execution::outstanding_work.tracked);
  worker_->give({std::move(secret), [weak, number, executor](std::optional<bool> right) {
                   asio::post(executor, [weak, number, right] {
                     if (const auto state = weak.lock()) state->onCompared(number, right);
                   });
                 }});
}

const PasswordCheck::Counters& PasswordCheck::counters() const {
  return state_->counters;
}

std::size_t PasswordCheck::remembered() const {
  return state_->tries.size();
}

}  // namespace naiad
