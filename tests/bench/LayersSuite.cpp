// The cost to a scene of layers that it does not use, by counts that other programs cannot disturb:
// valgrind's count of instructions, and the heap's of allocations. docs/bench.md describes the layers.
#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>

#include "ResultLine.h"
#include "Suite.h"
#include "tests/support/RunProgram.h"

namespace bench {
namespace {

std::filesystem::path besideThis(const std::string& name) {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path() / name;
}

std::filesystem::path fullProgram() {
  return besideThis("naiad_layers");
}

// Returns the path where deploy/bench puts the program built without layers.
std::filesystem::path bareProgram() {
  return besideThis("../../bench-bare/bin/naiad_layers").lexically_normal();
}

// Runs a command and returns all its output, including stderr.
std::string outputOf(const std::string& command) {
  const auto [code, output] = naiad::test::runProgram(command + " 2>&1");
  if (code != 0) throw std::runtime_error(command + ": " + output);
  return output;
}

double numberAfter(const std::string& text, const std::string& label) {
  const std::size_t at = text.find(label);
  if (at == std::string::npos) throw std::runtime_error("no '" + label + "' in: " + text);
  return std::stod(text.substr(at + label.size()));
}

/// Arguments of a naiad_layers run.
struct Setting {
  std::filesystem::path program;
  std::string scene;
  std::string layer = "none";
  std::string who = "one";
  double objects = 10'000;

  std::string command(int ticks) const {
    return "'" + program.string() + "' " + scene + " " + layer + " " + who + " " + std::to_string(ticks);
  }
};

double instructions(const Setting& setting, int ticks) {
  return numberAfter(
      outputOf("valgrind --tool=callgrind --callgrind-out-file=/dev/null " + setting.command(ticks)),
      "Collected :");
}

// Takes the difference of two runs of different lengths, which removes the cost of building the scene.
double instructionsPerObject(const Setting& setting, int ticks) {
  return (instructions(setting, 2 * ticks) - instructions(setting, ticks)) / ticks / setting.objects;
}

struct Heap {
  double bytes_per_object;
  double allocations_per_tick;
};

Heap heapOf(const Setting& setting, int ticks) {
  const std::string output = outputOf(setting.command(ticks));
  return {numberAfter(output, "bytes_per_object="), numberAfter(output, "allocations_per_tick=")};
}

void report(const std::string& layer, const Setting& with, const Setting& without,
            double without_instructions, int ticks) {
  const double instructions = instructionsPerObject(with, ticks);
  Setting all = with;
  all.who = "all";
  const Heap heap = heapOf(all, ticks);
  Line("layers")
      .add("layer", layer)
      .add("instructions_extra_percent", 100 * (instructions / without_instructions - 1))
      .add("bytes_extra", heap.bytes_per_object - heapOf(without, ticks).bytes_per_object)
      .add("allocations_per_tick", heap.allocations_per_tick)
      .add("n", static_cast<long long>(with.objects))
      .add("scene", with.scene)
      .add("instructions_per_object", instructions)
      .add("bytes_per_object", heap.bytes_per_object);
}

void run(const Options& options) {
  const int ticks = options.quick ? 5 : 20;
  if (!std::filesystem::exists(bareProgram()))
    throw std::runtime_error("no " + bareProgram().string() + "; deploy/bench builds it");
  for (const auto& [layer, scene] : {std::pair{"motion", "moving"}, {"motion_hard", "moving_hard"}}) {
    progress(std::string("layers: ") + layer);
    const Setting bare{bareProgram(), scene};
    report(layer, {fullProgram(), scene}, bare, instructionsPerObject(bare, ticks), ticks);
  }
  const Setting without{fullProgram(), "hard"};
  const double instructions = instructionsPerObject(without, ticks);
  for (const std::string layer : {"swept", "precise", "masks", "rest_contacts", "may_move_out"}) {
    progress("layers: " + layer);
    report(layer, {fullProgram(), "hard", layer}, without, instructions, ticks);
  }
  for (const auto& [scene, objects] : {std::pair{"hard_1000", 1'000.0}, {"hard_4000", 4'000.0}}) {
    for (const std::string who : {"one", "sixteen"}) {
      const Setting characters{fullProgram(), scene, "none", who, objects};
      const double alone = instructionsPerObject(characters, 5 * ticks);
      for (const std::string layer : {"sprite", "wall"}) {
        progress("layers: " + layer + ", " + who + ", " + scene);
        Setting with = characters;
        with.layer = layer;
        const double beside = instructionsPerObject(with, 5 * ticks);
        Line("layers")
            .add("layer", layer)
            .add("who", who)
            .add("instructions_extra_percent", 100 * (beside / alone - 1))
            .add("n", static_cast<long long>(objects))
            .add("scene", std::string(scene))
            .add("instructions_per_object", beside);
      }
    }
  }
}

const Suite s_suite("layers", "what scenes pay for what they do not use: instructions, bytes, allocations",
                    run);

}  // namespace
}  // namespace bench
