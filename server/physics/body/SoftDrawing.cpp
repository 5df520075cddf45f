#include "physics/body/SoftDrawing.h"

#include <algorithm>
#include <cmath>

#include "engine/managers/DisplayManager.h"
#include "physics/body/BodyFrames.h"
#include "physics/geometry/Index.h"
#include "shared/values/Vector.h"

namespace naiad::physics {

namespace {

// Limits of the cost of a drawing.
constexpr int kMaxSteps = 2000;          // cells of a line, rows of a filling, or cells of such a row
constexpr std::size_t kMaxCells = 8000;  // cells of a whole drawing

std::int64_t cellOf(double at) {
  return static_cast<std::int64_t>(std::floor(at + 0.5));
}

class Pen {
 public:
  Pen(SoftDrawn& drawn, const Metric& metric) : m_drawn(drawn), m_metric(metric) {
    for (const Place& place : drawn.nodes) m_points.push_back(metric.cellsOf(place));
  }

  void line(int a, int b) {
    const df::Vector from = m_points[at(a)], displacement = m_points[at(b)] - from;
    const char32_t ch = m_drawn.ch != 0 ? m_drawn.ch : lineAlong(m_metric.fromCells(displacement), 1);
    const double longer = std::max(std::fabs(displacement.x()), std::fabs(displacement.y()));
    const int steps = static_cast<int>(std::min(std::ceil(longer), static_cast<double>(kMaxSteps)));
    for (int i = 0; i <= steps; ++i) {
      const double part = steps > 0 ? static_cast<double>(i) / steps : 0;
      m_drawn.cells.push_back(
          {cellOf(from.x() + part * displacement.x()), cellOf(from.y() + part * displacement.y()), ch});
    }
  }

  // Fills the cells whose middle lies within the boundary, row by row.
  void fill(const std::vector<int>& boundary) {
    double low = 1e300, high = -1e300;
    for (const int node : boundary) {
      low = std::min(low, m_points[at(node)].y());
      high = std::max(high, m_points[at(node)].y());
    }
    if (!(high - low <= kMaxSteps)) return;
    for (std::int64_t y = cellOf(low); y <= cellOf(high); ++y) fillRow(boundary, y);
  }

 private:
  void fillRow(const std::vector<int>& boundary, std::int64_t y) {
    const auto middle = static_cast<double>(y);
    m_crossings.clear();
    for (std::size_t i = 0; i < boundary.size(); ++i) {
      const df::Vector a = m_points[at(boundary[i])], b = m_points[at(boundary[(i + 1) % boundary.size()])];
      if ((a.y() <= middle) == (b.y() <= middle)) continue;
      m_crossings.push_back(a.x() + (middle - a.y()) / (b.y() - a.y()) * (b.x() - a.x()));
    }
    std::sort(m_crossings.begin(), m_crossings.end());
    for (std::size_t i = 0; i + 1 < m_crossings.size(); i += 2) {
      const double first = std::ceil(m_crossings[i]), last = std::floor(m_crossings[i + 1]);
      if (!(last - first <= kMaxSteps)) continue;
      for (double x = first; x <= last; ++x) {
        m_drawn.cells.push_back({static_cast<std::int64_t>(x), y, m_drawn.ch != 0 ? m_drawn.ch : U'#'});
      }
    }
  }

  SoftDrawn& m_drawn;
  const Metric& m_metric;
  std::vector<df::Vector> m_points;
  std::vector<double> m_crossings;
};

bool isUpToDate(const SoftDrawn& drawn, const SoftBody& body, const Metric& metric) {
  constexpr double kSlack = 0.05;  // cells: smaller movements are not drawn
  if (drawn.nodes.size() != body.nodes.size()) return false;
  for (std::size_t i = 0; i < body.nodes.size(); ++i) {
    const df::Vector moved = metric.toCells(body.place + body.nodes[i].offset - drawn.nodes[i]);
    if (std::fabs(moved.x()) > kSlack || std::fabs(moved.y()) > kSlack) return false;
  }
  return true;
}

}  // namespace

void redraw(SoftDrawn& drawn, const SoftBody& body, const Metric& metric) {
  if (drawn.drawing == df::BodyDrawing::NONE || isUpToDate(drawn, body, metric)) return;
  drawn.nodes.clear();
  drawn.cells.clear();
  for (const SoftNode& node : body.nodes) drawn.nodes.push_back(body.place + node.offset);
  Pen pen(drawn, metric);
  for (std::size_t i = 1; i < body.boundary.size(); ++i) pen.line(body.boundary[i - 1], body.boundary[i]);
  if (body.is_closed) pen.line(body.boundary.back(), body.boundary.front());
  if (body.is_closed && drawn.drawing == df::BodyDrawing::FILL) pen.fill(body.boundary);
  // Only the first character of each cell is kept. Lines come before the filling.
  const auto isBefore = [](const SoftDrawn::Cell& a, const SoftDrawn::Cell& b) {
    return a.y != b.y ? a.y < b.y : a.x < b.x;
  };
  std::stable_sort(drawn.cells.begin(), drawn.cells.end(), isBefore);
  const auto isSame = [](const SoftDrawn::Cell& a, const SoftDrawn::Cell& b) {
    return a.y == b.y && a.x == b.x;
  };
  drawn.cells.erase(std::unique(drawn.cells.begin(), drawn.cells.end(), isSame), drawn.cells.end());
  if (drawn.cells.size() > kMaxCells) drawn.cells.resize(kMaxCells);
}

int put(const SoftDrawn& drawn) {
  if (drawn.drawing == df::BodyDrawing::NONE) return 0;
  int result = 0;
  for (const SoftDrawn::Cell& cell : drawn.cells) {
    const df::Vector where(static_cast<double>(cell.x), static_cast<double>(cell.y));
    if (DM.drawCh(where, cell.ch, drawn.color) != 0) result = -1;
  }
  return result;
}

}  // namespace naiad::physics
