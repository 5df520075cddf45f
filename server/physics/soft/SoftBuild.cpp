#include "physics/soft/SoftBuild.h"

#include "physics/geometry/Index.h"
#include "physics/geometry/Rotation.h"

namespace naiad::physics {

namespace {

bool isCount(int count) {
  return count >= 1 && count <= kMaxSoftNodes;
}

void connect(SoftBody& body, int a, int b, double ea) {
  const double rest = length(body.nodes[at(b)].offset - body.nodes[at(a)].offset);
  if (ea != 0) body.stretches.push_back({a, b, rest, ea / rest, 0});
}

SoftBody line(const Place& from, Vec2 displacement, int links, double mass, double ea) {
  SoftBody body;
  body.place = from;
  if (!isCount(links)) return body;  // without nodes, so that isValid() rejects the body
  body.radius = 0.25 * length(displacement) / links;
  for (int i = 0; i <= links; ++i) {
    SoftNode node;
    node.offset = static_cast<double>(i) / links * displacement;
    node.mass = mass / links * (i == 0 || i == links ? 0.5 : 1);
    body.nodes.push_back(node);
    body.boundary.push_back(i);
    if (i > 0) connect(body, i - 1, i, ea);
  }
  return body;
}

void bendLine(SoftBody& body, double ei) {
  if (ei == 0) return;
  for (int i = 1; i + 1 < static_cast<int>(body.nodes.size()); ++i) {
    const double link = length(body.nodes[at(i + 1)].offset - body.nodes[at(i)].offset);
    body.bends.push_back({i - 1, i, i + 1, 0, ei / link, 0, {1, 0}});
  }
}

}  // namespace

SoftBody makeRope(const Place& from, Vec2 displacement, int links, double mass, double stretch, double bend) {
  SoftBody body = line(from, displacement, links, mass, stretch);
  bendLine(body, bend);
  return body;
}

// Mass and bending are integrals along the beam, which are replaced by sums over the nodes. With weights of
// one half at the ends, the tip deflection and first frequency of 8 elements have errors of 0.8 % and 1.3 %;
// Gregory's weights remove this second-order error.
SoftBody makeBeam(const Place& from, Vec2 displacement, int elements, double ei, double ea, double density,
                  bool is_clamped) {
  constexpr double kEnd = 5.0 / 12, kNext = 13.0 / 12;
  const double whole = length(displacement), element = whole / elements;
  SoftBody body = line(from, displacement, elements, density * whole, ea);
  bendLine(body, ei);
  if (body.nodes.empty()) return body;
  const bool is_fine = elements >= 4;
  const std::size_t last = body.nodes.size() - 1;
  if (is_fine) {
    body.nodes[0].mass = body.nodes[last].mass = kEnd * density * element;
    body.nodes[1].mass = body.nodes[last - 1].mass = kNext * density * element;
  }
  if (!is_clamped) return body;
  body.nodes[0].is_pinned = true;
  if (ei == 0) return body;
  const double share = is_fine ? kEnd : 0.5;
  if (is_fine) body.bends[0].stiffness = ei / (kNext * element);
  body.bends.push_back({-1, 0, 1, 0, ei / (share * element), 0, displacement / whole});
  return body;
}

SoftBody makeCloth(const Place& corner, Vec2 along, Vec2 across, int columns, int rows, double mass,
                   double stretch, double shear, double bend) {
  SoftBody body;
  body.place = corner;
  if (!isCount(columns) || !isCount(rows) || !isCount((columns + 1) * (rows + 1))) return body;
  const auto id = [rows](int i, int j) { return j + i * (rows + 1); };
  for (int i = 0; i <= columns; ++i) {
    for (int j = 0; j <= rows; ++j) {
      SoftNode node;
      node.offset = static_cast<double>(i) / columns * along + static_cast<double>(j) / rows * across;
      node.mass = mass / columns / rows * (i % columns == 0 ? 0.5 : 1) * (j % rows == 0 ? 0.5 : 1);
      body.nodes.push_back(node);
      if (i > 0) connect(body, id(i - 1, j), id(i, j), stretch);
      if (j > 0) connect(body, id(i, j - 1), id(i, j), stretch);
      if (i > 0 && j > 0) {
        connect(body, id(i - 1, j - 1), id(i, j), shear);
        connect(body, id(i - 1, j), id(i, j - 1), shear);
      }
      const double link = length(along) / columns;
      if (i > 1 && bend != 0) {
        body.bends.push_back({id(i - 2, j), id(i - 1, j), id(i, j), 0, bend / link, 0, {1, 0}});
      }
    }
  }
  const double first = length(along) / columns, second = length(across) / rows;
  body.radius = 0.25 * (first < second ? first : second);
  body.is_closed = true;
  for (int i = 0; i < columns; ++i) body.boundary.push_back(id(i, 0));
  for (int j = 0; j < rows; ++j) body.boundary.push_back(id(columns, j));
  for (int i = columns; i > 0; --i) body.boundary.push_back(id(i, rows));
  for (int j = rows; j > 0; --j) body.boundary.push_back(id(0, j));
  if (cross(along, across) < 0) body.boundary = {body.boundary.rbegin(), body.boundary.rend()};
  return body;
}

SoftBody makeBlob(const Place& centre, double radius, int nodes, double mass, double pressure, double bulk,
                  double stretch, double bend) {
  SoftBody body;
  body.place = centre;
  if (!isCount(nodes) || nodes < 3) return body;
  const double step = 2 * 3.14159265358979323846 / nodes;
  for (int i = 0; i < nodes; ++i) {
    SoftNode node;
    node.offset = rotationBy(step * i) * Vec2{radius, 0};
    node.mass = mass / nodes;
    body.nodes.push_back(node);
    body.boundary.push_back(i);
    if (i > 0) connect(body, i - 1, i, stretch);
  }
  connect(body, nodes - 1, 0, stretch);
  const double side = length(body.nodes[1].offset - body.nodes[0].offset);
  for (int i = 0; i < nodes && bend != 0; ++i) {
    body.bends.push_back({i, (i + 1) % nodes, (i + 2) % nodes, step, bend / side, 0, {1, 0}});
  }
  body.is_closed = true;
  body.radius = 0.25 * side;
  body.pressure = pressure;
  body.bulk = bulk;
  body.rest_area = 0.5 * nodes * cross(body.nodes[0].offset, body.nodes[1].offset);
  return body;
}

}  // namespace naiad::physics
