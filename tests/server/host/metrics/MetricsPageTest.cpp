// The metrics page: its format, and that it includes every counter.
#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <memory>
#include <set>
#include <sstream>
#include <string>
#include <thread>
#include <type_traits>
#include <vector>

#include "host/metrics/Exposition.h"
#include "host/metrics/MetricsPage.h"
#include "host/ops/HostMetrics.h"
#include "tests/support/net/HttpClient.h"

namespace naiad {
namespace {

/// Renders the page with these values in one of the snapshot's structs, whose members are all counters.
template <class Struct>
std::string written(const std::vector<std::uint64_t>& values, Struct& (*part)(MetricsSnapshot&)) {
  static_assert(std::is_trivially_copyable_v<Struct>);
  MetricsSnapshot snapshot;
  std::memcpy(static_cast<void*>(&part(snapshot)), values.data(), sizeof(Struct));
  return renderMetrics(&snapshot, ProcessInfo());
}

/// Checks that a change of any single counter changes the page.
template <class Struct>
void expectAllWritten(Struct& (*part)(MetricsSnapshot&)) {
  constexpr std::size_t kCount = sizeof(Struct) / sizeof(std::uint64_t);
  std::vector<std::uint64_t> values(kCount);
  // A counter that counts a part of another comes after it and must be smaller.
  for (std::size_t i = 0; i < kCount; ++i) values[i] = 1000 * (kCount - i);
  const std::string before = written<Struct>(values, part);
  for (std::size_t i = 0; i < kCount; ++i) {
    ++values[i];
    EXPECT_NE(written<Struct>(values, part), before) << "counter " << i;
    --values[i];
  }
}

TEST(CounterFamilies, HaveEveryCounter) {
  expectAllWritten<Counters>([](MetricsSnapshot & all) -> auto& { return all.counters; });
  expectAllWritten<PasswordCheck::Counters>([](MetricsSnapshot & all) -> auto& { return all.passwords; });
  expectAllWritten<NetworkCounters>([](MetricsSnapshot & all) -> auto& { return all.network; });
}

TEST(CounterFamilies, PartialCountersAreSubtractedFromTheTotal) {
  MetricsSnapshot snapshot;
  snapshot.counters.snapshots = 10;
  snapshot.counters.datagram_snapshots = 7;
  const std::string page = renderMetrics(&snapshot, ProcessInfo());
  EXPECT_EQ(test::metricOf(page, R"(naiad_snapshots_total{path="stream"})"), 3);
  EXPECT_EQ(test::metricOf(page, R"(naiad_snapshots_total{path="datagram"})"), 7);
}

TEST(CounterFamilies, LogSummaryContainsEveryCounter) {
  constexpr std::size_t kCount = sizeof(Counters) / sizeof(std::uint64_t);
  for (std::size_t i = 0; i < kCount; ++i) {
    std::vector<std::uint64_t> values(kCount);
    values[i] = 5;
    Counters counters;
    std::memcpy(static_cast<void*>(&counters), values.data(), sizeof counters);
    EXPECT_TRUE(counters.summary().ends_with("=5")) << "counter " << i << ": " << counters.summary();
  }
}

std::string fullPage() {
  MetricsSnapshot snapshot;
  snapshot.counters.ticks = 3;
  snapshot.tick_durations.add(0.0004);
  snapshot.tick_lateness.add(2);
  snapshot.round_trips.add(0.04);
  snapshot.losses.add(0);
  snapshot.connected = 2;
  snapshot.stages[static_cast<std::size_t>(Stage::kWorld)] = std::chrono::milliseconds(1500);
  return renderMetrics(&snapshot, ProcessInfo::read());
}

TEST(MetricsPage, HasTheValues) {
  const std::string page = fullPage();
  EXPECT_EQ(test::metricOf(page, "naiad_ticks_total"), 3);
  EXPECT_EQ(test::metricOf(page, R"(naiad_players{state="connected"})"), 2);
  EXPECT_EQ(test::metricOf(page, R"(naiad_stage_seconds_total{stage="world"})"), 1.5);
  EXPECT_EQ(test::metricOf(page, R"(naiad_tick_duration_seconds_bucket{le="0.00025"})"), 0);
  EXPECT_EQ(test::metricOf(page, R"(naiad_tick_duration_seconds_bucket{le="0.0005"})"), 1);
  EXPECT_EQ(test::metricOf(page, R"(naiad_tick_duration_seconds_bucket{le="+Inf"})"), 1);
  EXPECT_EQ(test::metricOf(page, R"(naiad_tick_lateness_seconds_bucket{le="1"})"), 0);
  EXPECT_EQ(test::metricOf(page, "naiad_tick_lateness_seconds_count"), 1);
  EXPECT_EQ(test::metricOf(page, "naiad_tick_lateness_seconds_sum"), 2);
  EXPECT_EQ(test::metricOf(page, R"(naiad_loss_ratio_bucket{le="0"})"), 1);
}

// A family is a block of its HELP line, its TYPE line and its samples, each of which occurs once.
TEST(MetricsPage, FamiliesAreContiguousAndSamplesUnique) {
  std::istringstream lines(fullPage());
  std::set<std::string> families;
  std::set<std::string> samples;
  std::string family;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("# HELP ")) {
      family = line.substr(7, line.find(' ', 7) - 7);
      EXPECT_TRUE(families.insert(family).second) << family;
    } else if (line.starts_with("# TYPE ")) {
      EXPECT_TRUE(line.starts_with("# TYPE " + family + " ")) << line;
      const bool counts = line.ends_with(" counter");
      EXPECT_EQ(family.ends_with("_total"), counts) << line;
    } else {
      EXPECT_TRUE(line.starts_with(family)) << line;
      EXPECT_TRUE(samples.insert(line.substr(0, line.rfind(' '))).second) << line;
    }
    if (family.starts_with("process_")) continue;
    EXPECT_TRUE(family.starts_with("naiad_")) << family;
  }
  EXPECT_GT(families.size(), 50u);
  EXPECT_EQ(fullPage().back(), '\n');
}

TEST(MetricsPage, ShowsProcessMetricsBeforeTheFirstSnapshot) {
  const std::string page = renderMetrics(nullptr, ProcessInfo::read());
  EXPECT_NE(page.find("\nnaiad_build_info{version=\""), std::string::npos);
  EXPECT_EQ(page.find("naiad_ticks_total"), std::string::npos);
  EXPECT_GT(test::metricOf(page, "process_resident_memory_bytes"), 1e6);
  EXPECT_GE(test::metricOf(page, "process_open_fds"), 3);
  EXPECT_GE(test::metricOf(page, "process_max_fds"), test::metricOf(page, "process_open_fds"));
  EXPECT_GT(test::metricOf(page, "process_start_time_seconds"), 1.6e9);
  EXPECT_GE(test::metricOf(page, "process_cpu_seconds_total"), 0);
}

TEST(Exposition, LabelsAreEscaped) {
  EXPECT_EQ(metricLabel("a", "x\"y\\z\n"), R"(a="x\"y\\z\n")");
}

TEST(Exposition, NumbersAreWrittenExactly) {
  Exposition out;
  out.begin("n", MetricType::kGauge, "Help.");
  out.add("", 0.1);
  out.add(R"(a="c")", 1e-9);
  out.add(R"(a="b")", std::uint64_t{18446744073709551615u});
  EXPECT_EQ(
      out.text(),
      "# HELP n Help.\n# TYPE n gauge\nn 0.1\nn{a=\"c\"} 0.000000001\nn{a=\"b\"} 18446744073709551615\n");
}

TEST(LatestValue, IsTheNewestAndStaysUntilThereIsAnother) {
  LatestValue<int> value;
  EXPECT_EQ(value.readLatest(), nullptr);
  value.publish(std::make_unique<const int>(1));
  value.publish(std::make_unique<const int>(2));
  ASSERT_NE(value.readLatest(), nullptr);
  EXPECT_EQ(*value.readLatest(), 2);
  EXPECT_EQ(*value.readLatest(), 2);
  value.publish(std::make_unique<const int>(3));  // never taken: freed with `value`
}

struct Pair {
  int number = 0;
  int negative = 0;
};

TEST(LatestValue, ConcurrentReaderSeesWholeValuesInOrder) {
  constexpr int kLast = 20'000;
  LatestValue<Pair> value;
  std::thread writer([&value] {
    for (int i = 1; i <= kLast; ++i) value.publish(std::make_unique<const Pair>(Pair{i, -i}));
  });
  for (int newest = 0; newest < kLast;) {
    const Pair* p_pair = value.readLatest();
    if (p_pair == nullptr) continue;
    ASSERT_EQ(p_pair->number, -p_pair->negative);
    ASSERT_GE(p_pair->number, newest);
    newest = p_pair->number;
  }
  writer.join();
}

}  // namespace
}  // namespace naiad
