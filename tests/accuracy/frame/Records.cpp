#include "Records.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>

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
    json += c == '\n' ? ' ' : c;
  }
  return json + '"';
}

const char* nameOf(Problem::Kind kind) {
  switch (kind) {
    case Problem::Kind::DIAGRAM:
      return "diagram";
    case Problem::Kind::MAP:
      return "map";
    case Problem::Kind::COST:
      return "cost";
  }
  return "";
}

const char* nameOf(Method::Kind kind) {
  switch (kind) {
    case Method::Kind::PRODUCT:
      return "product";
    case Method::Kind::CANDIDATE:
      return "candidate";
    case Method::Kind::PEER:
      return "peer";
    case Method::Kind::TEXTBOOK:
      return "textbook";
  }
  return "";
}

Metric metricOf(const CpuBound& bound) {
  const std::string label =
      "time, of " + bound.method + "'s with " + std::to_string(bound.substeps) + " sub-steps";
  return {bound.name, label, bound.target, 0, ""};
}

}  // namespace

std::string metricName(const Case& its_case, const Metric& metric) {
  return its_case.name.empty() ? metric.name : metric.name + "_" + its_case.name;
}

Records::Records(const std::string& directory) {
  if (directory.empty()) return;
  std::filesystem::create_directories(directory);
  m_points = open(directory + "/points.csv");
  std::fputs(
      "problem,metric,method,version,substeps,error,cpu_us,cpu_us_min,cpu_us_max,worst_us,target,ok,"
      "failure\n",
      m_points);
  m_problems = open(directory + "/problems.json");
  std::fprintf(m_problems, "{\"build\": %s,\n\"methods\": [",
               quoted("GCC " __VERSION__ " " NAIAD_LAB_FLAGS).c_str());
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

void Records::describe(const Problem& problem) {
  if (m_problems == nullptr) return;
  std::fprintf(
      m_problems, "%s{\"id\": %s, \"name\": %s, \"title\": %s,\n \"text\": %s,\n \"reference\": %s,\n",
      m_first ? "\n" : ",\n", quoted(problem.id).c_str(), quoted(problem.name).c_str(),
      quoted(problem.title).c_str(), quoted(problem.text).c_str(), quoted(problem.reference).c_str());
  std::fprintf(m_problems, " \"kind\": \"%s\", \"metrics\": [", nameOf(problem.kind));
  m_first = false;
  const char* comma = "\n";
  for (const Case& its_case : problem.cases) {
    std::vector<Metric> metrics = its_case.metrics;
    for (const CpuBound& bound : its_case.cpu_bounds) metrics.push_back(metricOf(bound));
    for (const Metric& metric : metrics) {
      std::fprintf(
          m_problems,
          "%s  {\"name\": %s, \"case\": %s, \"label\": %s, \"target\": %.17g, \"floor\": %.17g, \"peers\": "
          "%s, \"x\": %.17g, \"tick\": %.17g}",
          comma, quoted(metricName(its_case, metric)).c_str(), quoted(its_case.name).c_str(),
          quoted(metric.label).c_str(), metric.target, metric.floor, quoted(metric.peers).c_str(), its_case.x,
          its_case.scene.tick);
      comma = ",\n";
    }
  }
  std::fputs("]}", m_problems);
  std::fflush(m_problems);
}

void Records::add(const Problem& problem, const Case& its_case, const Method& method, int substeps,
                  const Measurement& measurement) {
  for (std::size_t i = 0; i < its_case.metrics.size(); ++i) {
    const Metric& metric = its_case.metrics[i];
    const double error = measurement.errors[i];
    const bool judged = method.kind == Method::Kind::PRODUCT && metric.target >= 0;
    const bool met = error <= metric.target;
    bench::Line line("lab");
    line.add("problem", problem.id).add("metric", metricName(its_case, metric));
    line.add("method", method.name).add("version", method.version).add("substeps", substeps);
    line.add("error", error).add("cpu_us", measurement.cpu.median);
    line.add("cpu_us_min", measurement.cpu.least).add("cpu_us_max", measurement.cpu.most);
    line.add("worst_us", measurement.cpu.worst);
    if (judged) line.add("target", metric.target).add("ok", met ? 1 : 0);
    if (judged && !met) m_all_met = false;
    if (m_points == nullptr) continue;
    std::fprintf(m_points, "%s,%s,%s,%s,%d,%.6g,%.6g,%.6g,%.6g,%.6g,", problem.id.c_str(),
                 metricName(its_case, metric).c_str(), method.name.c_str(), method.version.c_str(), substeps,
                 error, measurement.cpu.median, measurement.cpu.least, measurement.cpu.most,
                 measurement.cpu.worst);
    if (judged)
      std::fprintf(m_points, "%.6g,%d", metric.target, met ? 1 : 0);
    else
      std::fputs(",", m_points);
    std::fprintf(m_points, ",%s\n", measurement.reason.c_str());
  }
  if (m_points != nullptr) std::fflush(m_points);
}

void Records::add(const Problem& problem, const Case& its_case, const CpuBound& bound, const Method& method,
                  int substeps, const Measurement& measurement, const CpuTime& compared) {
  if (method.kind != Method::Kind::PRODUCT && method.kind != Method::Kind::CANDIDATE) return;
  Case timed;
  timed.name = its_case.name;
  timed.metrics = {metricOf(bound)};
  Measurement ratio;
  ratio.errors = {measurement.cpu.median / compared.median};
  ratio.cpu = measurement.cpu;
  add(problem, timed, method, substeps, ratio);
}

}  // namespace lab
