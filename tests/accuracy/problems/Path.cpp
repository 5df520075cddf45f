#include "Path.h"

#include <algorithm>
#include <cmath>

namespace lab {

Path pathOf(int ticks, const std::function<std::vector<Quad>(Quad t)>& place) {
  Path path;
  for (int tick = 0; tick <= ticks; ++tick) {
    const std::vector<Quad> exact = place(Quad(kTick) * tick);
    path.emplace_back(exact.begin(), exact.end());
  }
  return path;
}

PathErrors compare(const Trial& trial, const Scene& scene, const Path& reference, double scale,
                   const Read& read) {
  PathErrors errors;
  trial.run(scene, [&](int tick, const Simulation& simulation) {
    const std::vector<double> values = read(simulation);
    const std::vector<double>& right = reference[static_cast<std::size_t>(tick)];
    double square = 0;
    for (std::size_t i = 0; i < right.size(); ++i) square += (values[i] - right[i]) * (values[i] - right[i]);
    errors.end = std::sqrt(square) / scale;
    errors.sup = std::max(errors.sup, errors.end);
  });
  return errors;
}

std::vector<double> positionOf(const Simulation& simulation, int index) {
  const Vec position = simulation.body(index).position;
  return {position.x, position.y};
}

std::vector<double> coordinatesOf(const Simulation& simulation) {
  const auto coordinates = simulation.coordinates();
  if (coordinates.empty()) throw Inexpressible();
  return {coordinates.begin(), coordinates.end()};
}

std::vector<Metric> pathMetrics(double target, double floor) {
  return {{"end_error", "relative error at the end", target, floor},
          {"sup_error", "largest relative error over the run", target, floor}};
}

std::vector<double> inOrder(const PathErrors& errors) {
  return {errors.end, errors.sup};
}

Judge alongPath(const Scene& scene, const Path& path, double scale, const Read& read) {
  return [=](const Trial& trial) { return inOrder(compare(trial, scene, path, scale, read)); };
}

Judge atEnd(const Scene& scene, const std::function<double(const Simulation& end)>& error) {
  return [=](const Trial& trial) { return std::vector<double>{error(*trial.run(scene))}; };
}

Whole motionOf(const Scene& scene, const Simulation& simulation) {
  Whole all;
  for (int i = 0; i < static_cast<int>(scene.bodies.size()); ++i) {
    const double mass = scene.bodies[static_cast<std::size_t>(i)].mass;
    const Vec velocity = simulation.body(i).velocity;
    all.momentum = all.momentum + mass * velocity;
    all.energy += 0.5 * mass * dot(velocity, velocity);
    all.sum += mass * length(velocity);
  }
  return all;
}

std::vector<Case> mapOf(double most, Case (*make)(double value), const Metric& metric, double unit) {
  std::vector<Case> cases;
  for (double value = 1; value < 2 * most; value *= 10) {
    Case cell = make(value);
    cell.x = value;
    cell.cpu_bounds.clear();
    cell.metrics = {metric};
    cell.judge = [judge = cell.judge, unit](const Trial& trial) {
      return std::vector<double>{judge(trial)[0] / unit};
    };
    cases.push_back(cell);
  }
  return cases;
}

std::string power(double value) {
  return "1e" + std::to_string(std::lround(std::log10(value)));
}

}  // namespace lab
