#include "Records.h"

#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <vector>

#include "ResultLine.h"

namespace lab {
namespace {

std::FILE* open(const std::string& path) {
  std::FILE* file = std::fopen(path.c_str(), "w");
  if (file == nullptr) throw std::runtime_error(path + ": " + std::strerror(errno));
  return file;
}

std::string quoted(const std::string& text) {
  std::string json = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') json += '\\';
    if (c == '\n') {
      json += "\\n";
    } else {
      json += c;
    }
  }
  return json + '"';
}

// Names in the order of the enumerations.
const char* nameOf(Problem::Kind kind) {
  constexpr const char* kNames[] = {"diagram", "map"};
  return kNames[static_cast<int>(kind)];
}

const char* nameOf(Method::Kind kind) {
  constexpr const char* kNames[] = {"product", "fast", "candidate", "peer", "textbook"};
  return kNames[static_cast<int>(kind)];
}

// Returns all metrics of a case.
std::vector<Metric> metricsOf(const Problem& problem, const Case& its_case) {
  std::vector<Metric> metrics = its_case.metrics;
  for (const CpuBound& bound : its_case.cpu_bounds) metrics.push_back(bound.metric());
  if (problem.kind == Problem::Kind::DIAGRAM) metrics.push_back(Case::worstTick());
  return metrics;
}

const char* commaAfter(const bool is_first) {
  return is_first ? "\n" : ",\n";
}

}  // namespace

std::string metricName(const Case& its_case, const Metric& metric) {
  return its_case.name.empty() ? metric.name : metric.name + "_" + its_case.name;
}

Records::Records(const std::string& directory, int runs) {
  if (directory.empty()) return;
  std::filesystem::create_directories(directory);
  m_points = open(directory + "/points.csv");
  std::fputs(
      "problem,metric,method,version,substeps,error,cpu_us,cpu_us_min,cpu_us_max,worst_us,target,ok,"
      "failure\n",
      m_points);
  m_problems = open(directory + "/problems.json");
  std::fprintf(m_problems, "{\"build\": %s,\n\"runs\": %d,\n\"methods\": [",
               quoted("GCC " __VERSION__ " " NAIAD_LAB_FLAGS).c_str(), runs);
  const char* comma = "\n";
  for (const Method* method : Method::all()) {
    std::fprintf(m_problems, "%s  {\"name\": %s, \"label\": %s, \"version\": %s, \"kind\": \"%s\"}", comma,
                 quoted(method->name).c_str(), quoted(method->label).c_str(), quoted(method->version).c_str(),
                 nameOf(method->kind));
    comma = ",\n";
  }
  std::fputs("],\n\"problems\": [", m_problems);
}

Records::~Records() {
  if (m_points == nullptr) return;
  std::fclose(m_points);
  std::fputs("]}\n", m_problems);
  std::fclose(m_problems);
}

void Records::describe(const Problem& problem, const std::vector<Case>& cases) {
  if (m_problems == nullptr) return;
  std::fprintf(m_problems, "%s{", commaAfter(m_first));
  m_first = false;
  describe("id", problem.id);
  describe("name", problem.name);
  describe("title", problem.title);
  describe("why", problem.why);
  std::fprintf(m_problems, "\"kind\": \"%s\", \"metrics\": [", nameOf(problem.kind));
  bool is_first = true;
  for (const Case& its_case : cases) {
    for (const Metric& metric : metricsOf(problem, its_case)) {
      std::fputs(commaAfter(is_first), m_problems);
      is_first = false;
      describe(its_case, metric);
    }
  }
  std::fputs("]}", m_problems);
  std::fflush(m_problems);
}

void Records::describe(const char* key, const std::string& value) {
  std::fprintf(m_problems, "\"%s\": %s,\n ", key, quoted(value).c_str());
}

void Records::describe(const Case& its_case, const Metric& metric) {
  std::fputs("  {", m_problems);
  describe("name", metricName(its_case, metric));
  describe("case", its_case.name);
  describe("case_label", its_case.label);
  describe("label", metric.label);
  std::fprintf(m_problems,
               "\"target\": %.17g, \"fast_target\": %.17g, \"floor\": %.17g, \"x\": %.17g, \"tick\": %.17g}",
               metric.target, metric.fast_target, metric.floor, its_case.x, its_case.scene.tick);
}

void Records::add(const Problem& problem, const Case& its_case, const Method& method, int substeps,
                  const Measurement& measurement) {
  for (std::size_t i = 0; i < its_case.metrics.size(); ++i)
    add(problem, its_case, its_case.metrics[i], method, substeps, measurement.errors[i], measurement);
  const bool counts_ticks = problem.kind == Problem::Kind::DIAGRAM && method.isJudgedAt(substeps);
  if (counts_ticks && !std::isnan(measurement.cpu.worst_part)) {
    Measurement timed;  // only the times, without the reason of a failure
    timed.cpu = measurement.cpu;
    add(problem, its_case, Case::worstTick(), method, substeps, timed.cpu.worst_part, timed);
  }
}

void Records::add(const Problem& problem, const Case& its_case, const Metric& metric, const Method& method,
                  int substeps, double error, const Measurement& measurement) {
  const double target = metric.targetOf(method);
  const bool judged = method.isJudgedAt(substeps) && target >= 0;
  const bool met = error <= target;
  bench::Line line("lab");
  line.add("problem", problem.id).add("metric", metricName(its_case, metric));
  line.add("method", method.name).add("version", method.version).add("substeps", substeps);
  line.add("error", error).add("cpu_us", measurement.cpu.median);
  line.add("cpu_us_min", measurement.cpu.least).add("cpu_us_max", measurement.cpu.most);
  line.add("worst_us", measurement.cpu.worst);
  if (judged) line.add("target", target).add("ok", met ? 1 : 0);
  if (judged && !met) m_all_met = false;
  if (m_points == nullptr) return;
  std::fprintf(m_points, "%s,%s,%s,%s,%d,%.6g,%.6g,%.6g,%.6g,%.6g,", problem.id.c_str(),
               metricName(its_case, metric).c_str(), method.name.c_str(), method.version.c_str(), substeps,
               error, measurement.cpu.median, measurement.cpu.least, measurement.cpu.most,
               measurement.cpu.worst);
  if (judged)
    std::fprintf(m_points, "%.6g,%d", target, met ? 1 : 0);
  else
    std::fputs(",", m_points);
  std::fprintf(m_points, ",%s\n", measurement.reason.c_str());
  std::fflush(m_points);
}

void Records::add(const Problem& problem, const Case& its_case, const CpuBound& bound, const Method& method,
                  int substeps, const Measurement& measurement, double part) {
  if (!method.isProduct() && method.kind != Method::Kind::CANDIDATE) return;
  Measurement timed;
  timed.cpu = measurement.cpu;
  add(problem, its_case, bound.metric(), method, substeps, part, timed);
}

}  // namespace lab
