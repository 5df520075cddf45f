#include "host/auth/PasswordCheck.h"

#include <openssl/crypto.h>

#include <asio/execution/outstanding_work.hpp>
#include <asio/post.hpp>
#include <asio/prefer.hpp>
#include <map>
#include <optional>
#include <utility>

#include "host/auth/LoginRateLimit.h"
#include "host/auth/PasswordQueue.h"
#include "shared/program/JobThread.h"

namespace naiad {
namespace {

/// A secret that is wiped on destruction.
struct Secret {
  explicit Secret(std::string secret) : text(std::move(secret)) {}
  ~Secret() { OPENSSL_cleanse(text.data(), text.size()); }
  Secret(const Secret&) = delete;
  Secret& operator=(const Secret&) = delete;
  std::string text;
};

}  // namespace

/// The owner's side, with all callbacks, which the worker never touches, copies or destroys. Jobs posted by
/// the worker hold a weak pointer to this object, so they do nothing after its end.
struct PasswordCheck::State : std::enable_shared_from_this<State> {
  State(asio::any_io_executor executor, PasswordHash with_hash, const Limits& limits, JobThread& with_worker)
      : owner(std::move(executor)),
        hash(std::make_shared<const PasswordHash>(std::move(with_hash))),
        worker(with_worker),
        queue(limits.queue - 1, limits.prefixes),
        tries(limits.wrong_per_window, limits.window, limits.prefixes) {}

  using Time = LoginRateLimit::Time;

  asio::any_io_executor owner;
  std::shared_ptr<const PasswordHash> hash;
  JobThread& worker;
  PasswordQueue queue;
  LoginRateLimit tries;
  Counters counters;
  struct Guess {
    AddressPrefix from;
    Time at;
    std::shared_ptr<const Secret> password;
    std::function<void(Answer)> done;
  };
  std::map<PasswordQueue::Id, Guess> guesses;  // guesses that have no answer yet
  bool comparing = false;
  PasswordQueue::Id newest = 0;

  void answerLater(Answer answer, std::function<void(Answer)> done);
  void add(bool known, Guess guess);
  void compareNext();
  void onCompared(PasswordQueue::Id id, std::optional<bool> right);
};

// If the State has ended when the job runs, `done` is destroyed without a call.
void PasswordCheck::State::answerLater(Answer answer, std::function<void(Answer)> done) {
  asio::post(owner, [weak = weak_from_this(), answer, call = std::move(done)] {
    if (!weak.expired()) call(answer);
  });
}

void PasswordCheck::State::add(bool known, Guess guess) {
  const PasswordQueue::Id id = ++newest;
  const auto loser = queue.add({id, guess.from, known, tries.wrong(guess.from, guess.at)}, guess.at);
  guesses.emplace(id, std::move(guess));
  if (!comparing) return compareNext();  // the queue was empty, so no guess was dropped
  if (!loser) return;
  Guess lost = std::move(guesses.extract(*loser).mapped());
  tries.finishTry(lost.from, true, lost.at);
  ++counters.busy;
  answerLater(Answer::kBusy, std::move(lost.done));
}

void PasswordCheck::State::compareNext() {
  const auto id = queue.popNext();
  comparing = id.has_value();
  if (!comparing) return;
  // Keeps the owner's loop running while an answer is still to come.
  auto executor = asio::prefer(owner, asio::execution::outstanding_work.tracked);
  worker.enqueue(
      [weak = weak_from_this(), id = *id, executor, now = hash, password = guesses.at(*id).password] {
        std::optional<bool> right;  // nullopt: not enough memory to compare
        try {
          right = now->matches(password->text);
        } catch (const PasswordError&) {
        }
        asio::post(executor, [weak, id, right] {
          if (const auto state = weak.lock()) state->onCompared(id, right);
        });
      });
}

void PasswordCheck::State::onCompared(PasswordQueue::Id id, std::optional<bool> right) {
  const auto guess = guesses.extract(id);
  const auto& [from, at, password, done] = guess.mapped();
  tries.finishTry(from, right.value_or(true), at);
  ++(!right ? counters.busy : *right ? counters.right : counters.wrong);
  compareNext();  // before the callback, which may destroy this
  done(!right ? Answer::kNoMemory : *right ? Answer::kRight : Answer::kWrong);
}

PasswordCheck::PasswordCheck(asio::any_io_executor owner, PasswordHash hash, Limits limits)
    : worker_(std::make_unique<JobThread>()),
      state_(std::make_shared<State>(std::move(owner), std::move(hash), limits, *worker_)) {
  worker_->enqueue([] {});  // starts the thread now, because later it might fail
}

PasswordCheck::~PasswordCheck() = default;

void PasswordCheck::check(const AddressPrefix& from, bool known, std::string password,
                          std::chrono::steady_clock::time_point now, std::function<void(Answer)> done) {
  auto secret = std::make_shared<const Secret>(std::move(password));
  if (secret->text.empty() || secret->text.size() > kMaxPassword) {
    ++state_->counters.malformed;
    return state_->answerLater(Answer::kWrong, std::move(done));
  }
  switch (state_->tries.beginTry(from, now)) {
    case LoginRateLimit::Answer::kAllowed:
      return state_->add(known, {from, now, std::move(secret), std::move(done)});
    case LoginRateLimit::Answer::kTooMany:
      ++state_->counters.too_many;
      return state_->answerLater(Answer::kTooMany, std::move(done));
    case LoginRateLimit::Answer::kWait:
      ++state_->counters.busy;
      return state_->answerLater(Answer::kBusy, std::move(done));
  }
}

void PasswordCheck::setHash(PasswordHash hash) {
  state_->hash = std::make_shared<const PasswordHash>(std::move(hash));
}

const PasswordCheck::Counters& PasswordCheck::counters() const {
  return state_->counters;
}

std::size_t PasswordCheck::remembered() const {
  return state_->tries.size();
}

}  // namespace naiad
