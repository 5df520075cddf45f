// The command line of dfserver: what would start a server that nobody meant is an error.
#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include "HostOptions.h"

namespace naiad {
namespace {

CommandLine parse(const std::vector<const char*>& arguments, HostOptions& options) {
  std::vector<const char*> all = {"dfserver"};
  all.insert(all.end(), arguments.begin(), arguments.end());
  return parseHostOptions(static_cast<int>(all.size()), all.data(), options);
}

TEST(HostOptions, AMisspeltOptionInTheConfigFileIsAnError) {
  const std::string path = testing::TempDir() + "naiad_host_options.ini";
  std::ofstream(path) << "ticks = 3\n";
  HostOptions options;
  EXPECT_EQ(parse({"--config", path.c_str()}, options), CommandLine::kRun);
  EXPECT_EQ(options.ticks, 3);
  std::ofstream(path) << "ticsk = 3\n";
  EXPECT_EQ(parse({"--config", path.c_str()}, options), CommandLine::kUsageError);
  std::remove(path.c_str());
}

TEST(HostOptions, ATickThatNoClientWouldBelieveIsAnError) {
  HostOptions options;
  EXPECT_EQ(parse({"--frame-time", "999"}, options), CommandLine::kUsageError);
  EXPECT_EQ(parse({"--frame-time", "1000"}, options), CommandLine::kRun);
  EXPECT_EQ(parse({"--frame-time", "0"}, options), CommandLine::kRun);
}

}  // namespace
}  // namespace naiad
