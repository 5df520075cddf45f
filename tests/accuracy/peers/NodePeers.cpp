// Box2D v3 and Rapier from npm, which run as WebAssembly in node: engines.mjs explains the commands.
// `substeps` are whole steps of tick / substeps with the engine's defaults. Only errors are compared, because
// the times would be WebAssembly's. Without the packages, which deploy/lab fetches, these methods do not
// exist.
#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <iomanip>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "tests/accuracy/frame/Method.h"
#include "tests/accuracy/frame/Trial.h"

namespace lab {
namespace {

constexpr std::size_t kNumbers = 6;  // of a body's state

// A node process with the worlds of one engine.
class EngineProcess {
 public:
  explicit EngineProcess(const std::string& engine) {
    std::signal(SIGPIPE, SIG_IGN);  // a crash of the engine is a failed measurement
    std::array<int, 2> answers{};
    if (pipe(answers.data()) != 0) throw std::runtime_error("no pipe");
    fcntl(answers[0], F_SETFD, FD_CLOEXEC);  // so that node cannot write after the end of this process
    const std::string command = "exec node '" NAIAD_LAB_ENGINES "' " + engine + " '" NAIAD_LAB_PEERS "' ";
    m_commands = popen((command + std::to_string(answers[1])).c_str(), "w");
    close(answers[1]);
    m_answers = fdopen(answers[0], "r");
    if (m_commands == nullptr || m_answers == nullptr) throw std::runtime_error("no process");
  }
  ~EngineProcess() {
    pclose(m_commands);  // node ends at the end of its input
    std::fclose(m_answers);
  }
  EngineProcess(const EngineProcess&) = delete;
  EngineProcess& operator=(const EngineProcess&) = delete;

  // Returns the process of this engine. A forked process gets one of its own.
  static EngineProcess& of(const std::string& engine) {
    static std::map<std::pair<pid_t, std::string>, EngineProcess> s_processes;
    return s_processes.try_emplace({getpid(), engine}, engine).first->second;
  }

  int addWorld() { return ++m_worlds; }
  void write(const std::string& commands) { std::fputs(commands.c_str(), m_commands); }
  // Waits for the answer. Throws Failure if the process has ended or is silent for two minutes.
  void read(std::vector<double>& answer) {
    constexpr int kPatienceMs = 120'000;
    std::fflush(m_commands);
    pollfd answers{fileno(m_answers), POLLIN, 0};
    if (poll(&answers, 1, kPatienceMs) == 0 ||
        std::fread(answer.data(), sizeof(double), answer.size(), m_answers) != answer.size())
      throw Failure("crashed or took too long");
  }

 private:
  std::FILE* m_commands = nullptr;
  std::FILE* m_answers = nullptr;
  int m_worlds = 0;
};

class NodePeer : public Simulation {
 public:
  NodePeer(const std::string& engine, const Scene& scene)
      : m_process(EngineProcess::of(engine)),
        m_id(' ' + std::to_string(m_process.addWorld())),
        m_field(scene.field),
        m_origin(scene.origin),
        m_counts_contacts(scene.counts_contacts),
        m_answer(1 + kNumbers * scene.bodies.size()) {
    write("scene", scene.gravity.x, scene.gravity.y, scene.may_sleep);
    for (const Body& body : scene.bodies) add(body, scene.collides);
    for (const Joint& joint : scene.joints) {
      const Vec a = m_origin + joint.anchor_a, b = m_origin + joint.anchor_b;
      write("joint", static_cast<int>(joint.kind), joint.a, joint.b, a.x, a.y, b.x, b.y, joint.stiffness,
            joint.damping, joint.rest_length);
    }
    advance(0, 0);
  }
  ~NodePeer() override { write("free"); }
  NodePeer(const NodePeer&) = delete;
  NodePeer& operator=(const NodePeer&) = delete;

  void step(double tick, int substeps) override {
    const double h = tick / substeps;
    if (!m_field) advance(h, substeps);
    for (int i = 0; m_field && i < substeps; ++i, m_time += h) advance(h, 1);
  }

  BodyState body(int index) const override {
    const double* state = &m_answer[1 + kNumbers * static_cast<std::size_t>(index)];
    return {Vec{state[0], state[1]} - m_origin, {state[2], state[3]}, state[4], state[5]};
  }
  long contacts() const override { return m_counts_contacts ? static_cast<long>(m_answer[0]) : 0; }

 private:
  template <class... Numbers>
  void write(const char* command, Numbers... numbers) {
    std::ostringstream line;
    line << std::setprecision(17) << command << m_id;
    ((line << ' ' << numbers), ...);
    m_process.write(line.str() + '\n');
  }

  void add(const Body& body, bool collides) {
    const bool rotates = body.rotates && !body.shapes.empty();
    const double inertia = rotates ? body.mass * inertiaOf(body.shapes.back()) : 0;
    const Vec at = m_origin + body.position;
    write("body", static_cast<int>(body.motion), at.x, at.y, body.angle, body.velocity.x, body.velocity.y,
          body.spin, body.mass, inertia, body.fast, body.linear_drag);
    if (!collides) return;
    for (const Shape& shape : body.shapes) {
      const Vec centre = shape.centre;
      if (shape.kind == Shape::Kind::CIRCLE)
        write("shape", centre.x, centre.y, body.friction, body.restitution, shape.radius);
      else
        write("shape", centre.x, centre.y, body.friction, body.restitution, shape.half.x, shape.half.y);
    }
  }

  void advance(double h, int count) {
    std::ostringstream pushes;
    pushes << std::setprecision(17) << count;
    for (int i = 0; m_field && count > 0 && i < static_cast<int>(m_answer.size() / kNumbers); ++i) {
      const Vec acceleration = m_field(m_time, body(i));
      pushes << ' ' << acceleration.x << ' ' << acceleration.y;
    }
    write("step", h, pushes.str());
    m_process.read(m_answer);
  }

  EngineProcess& m_process;
  std::string m_id;  // with a blank before it
  Field m_field;
  Vec m_origin;
  bool m_counts_contacts;
  double m_time = 0;
  std::vector<double> m_answer;  // the number of contacts, then the states
};

bool hasRods(const Scene& scene) {
  return std::ranges::find(scene.joints, Joint::Kind::ROD, &Joint::kind) != scene.joints.end();
}

// Registers a method if its package is there.
void add(const std::string& name, const std::string& label, const std::string& package,
         const std::string& version, bool has_rods) {
  if (!std::filesystem::exists(NAIAD_LAB_PEERS "/node_modules/" + package)) return;
  const auto build = [=](const Scene& scene) -> SimulationPtr {
    const bool is_possible = scene.rigid() && (has_rods || !hasRods(scene));
    return is_possible ? std::make_unique<NodePeer>(name, scene) : nullptr;
  };
  RegisteredMethod({name, label, version, Method::Kind::PEER, build, 0, false});
}

const bool are_added = [] {
  add("box2d3", "Box2D 3.2", "box2d3-wasm", "3.2-npm-5.2.0", true);
  add("rapier", "Rapier", "@dimforge/rapier2d-deterministic-compat", "npm-0.20.0", false);
  return true;
}();

}  // namespace
}  // namespace lab
