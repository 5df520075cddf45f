// screen: share of a player's picture that differs from the server's at an equal instant, and the cost in
// bytes and processor time, for several network conditions.
//
// The 1000-object world in an 80 by 24 view, over a line in virtual time. At 1000 random instants the
// client's picture is compared with the truth of the server's newest tick, over the cells that are not blank
// in at least one of the two. `floor_percent`: the result for a client that knows the exact state of the
// newest tick that could have arrived, and extrapolates from it. `still_percent`: the result for a client
// that shows that tick unchanged. `ahead`: 1 if the picture is drawn ahead by the snapshots' delay.
#include <algorithm>
#include <chrono>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "ResultLine.h"
#include "Suite.h"
#include "engine/world/Capture.h"
#include "net/BusyScene.h"
#include "net/LinkedClient.h"
#include "shared/values/SplitMix64.h"

namespace bench {
namespace {

using namespace naiad;
using namespace std::chrono_literals;

/// Share of different cells, among the cells that are not blank in at least one of the two pictures.
struct Share {
  long long wrong = 0;
  long long all = 0;
  void add(const df::Canvas& a, const df::Canvas& b) {
    for (int y = 0; y < a.height(); ++y) {
      for (int x = 0; x < a.width(); ++x) {
        if (a.at(x, y).ch == U' ' && b.at(x, y).ch == U' ') continue;
        ++all;
        wrong += a.at(x, y) == b.at(x, y) ? 0 : 1;
      }
    }
  }
  double percent() const {
    return all > 0 ? 100.0 * static_cast<double>(wrong) / static_cast<double>(all) : 0;
  }
};

struct Case {
  std::chrono::milliseconds round_trip;
  double loss;
  Resend resend;
  const char* policy;
  bool ahead;
};

void measure(const Case& c, bool quick) {
  constexpr int kPlayers = 8;
  const int instants = quick ? 100 : 1000;
  BusyScene scene(BusyScene::Kind::kBusy, 80, 24, kPlayers);
  VirtualClock clock;
  LinkConditions link;
  link.delay = c.round_trip / 2;
  link.loss = c.loss;
  Publisher publisher;
  std::vector<std::unique_ptr<LinkedClient>> clients;
  for (int i = 0; i < kPlayers; ++i) {
    clients.push_back(std::make_unique<LinkedClient>(clock, link, static_cast<std::uint64_t>(i), c.resend));
  }
  // Number of ticks whose pictures are kept: the newest one that can have arrived at the client, and all
  // later ones.
  const auto kept = static_cast<std::size_t>(link.delay / kTickLength) + 2;
  std::vector<std::deque<df::Canvas>> truths(kPlayers);
  // Ideal clients, which receive everything at once, and copies of their replicas from the last ticks.
  std::vector<std::unique_ptr<LinkedClient>> ideals;
  std::vector<std::deque<Replica>> known(kPlayers);
  for (int i = 0; i < kPlayers; ++i) {
    ideals.push_back(std::make_unique<LinkedClient>(clock, LinkConditions{}, 1, Resend::kOnGap));
  }
  SplitMix64 random(1);
  Share seen;
  Share floor;
  Share still;
  constexpr int kWarmUp = 300;
  for (int i = 0; i < kWarmUp + instants; ++i) {
    if (i == kWarmUp) {
      for (auto& client : clients) client->resetFigures();
    }
    scene.tick();
    publisher.update(scene.world().picture().view());
    const auto& facts = scene.world().picture().view().players;
    for (std::size_t p = 0; p < facts.size(); ++p) {
      clients[p]->tick(publisher, facts[p]);
      ideals[p]->tick(publisher, facts[p]);
      truths[p].push_front(scene.truth(facts[p].id));
      if (truths[p].size() > kept) truths[p].pop_back();
    }
    // A random instant between this tick and the next.
    const std::chrono::microseconds offset(random.below(static_cast<std::uint64_t>(kTickLength.count())));
    clock.advanceBy(offset);
    for (std::size_t p = 0; p < facts.size(); ++p) {
      known[p].push_front(ideals[p]->replica());
      if (known[p].size() > kept) known[p].pop_back();
    }
    for (std::size_t p = 0; i >= kWarmUp && p < facts.size(); ++p) {
      LinkedClient& client = *clients[p];
      client.displayClock().setDelay(c.ahead ? link.delay : 0us);
      const std::uint32_t drawn =
          std::max(client.displayClock().displayTick(client.now()), client.displayClock().newestTick());
      seen.add(truths[p].front(), client.replica().render(drawn));
      const std::int64_t age = (link.delay - offset + kTickLength - 1us) / kTickLength;
      const auto newest = static_cast<std::size_t>(std::max<std::int64_t>(age, 0));
      floor.add(truths[p].front(), known[p][newest].render(publisher.tick()));
      still.add(truths[p].front(), truths[p][newest]);
    }
    clock.advanceBy(kTickLength - offset);
  }
  double bytes = 0;
  double encode = 0;
  for (const auto& client : clients) {
    bytes += static_cast<double>(client->bytes_down);
    encode += std::chrono::duration<double, std::micro>(client->encode).count();
  }
  const double ticks = static_cast<double>(kPlayers) * instants;
  Line("screen")
      .add("rtt_ms", static_cast<int>(c.round_trip / 1ms))
      .add("loss_percent", 100 * c.loss)
      .add("resend", std::string(c.policy))
      .add("ahead", c.ahead ? 1 : 0)
      .add("wrong_percent", seen.percent())
      .add("floor_percent", floor.percent())
      .add("still_percent", still.percent())
      .add("kbit_s", 8 * bytes / 1000 / (ticks / 30))
      .add("cpu_us", encode / ticks);
}

const Suite s_suite("screen", "wrong cells on a player's screen, against bytes and microseconds",
                    [](const Options& options) {
                      for (const auto round_trip : {0ms, 50ms, 100ms, 200ms}) {
                        for (const bool ahead : {false, true})
                          measure({round_trip, 0, Resend::kAhead, "ahead", ahead}, options.quick);
                      }
                      for (const double loss : {0.02, 0.1}) {
                        measure({100ms, loss, Resend::kEveryTick, "every", false}, options.quick);
                        measure({100ms, loss, Resend::kOnGap, "gap", false}, options.quick);
                        measure({100ms, loss, Resend::kAhead, "ahead", false}, options.quick);
                      }
                    });

}  // namespace
}  // namespace bench
