#include "Cvode.h"

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <algorithm>
#include <stdexcept>
#include <string>

namespace lab {
namespace {

constexpr long kMaxStepsPerTick = 50000000;

int rateOf(double t, N_Vector y, N_Vector rates, void* user) {
  static_cast<const OdeFunctions*>(user)->rate(t, N_VGetArrayPointer(y), N_VGetArrayPointer(rates));
  return 0;
}

int jacobianOf(double t, N_Vector y, N_Vector, SUNMatrix jacobian, void* user, N_Vector, N_Vector, N_Vector) {
  static_cast<const OdeFunctions*>(user)->jacobian(t, N_VGetArrayPointer(y), SUNDenseMatrix_Data(jacobian));
  return 0;
}

void demand(int status, const char* what) {
  if (status < 0) throw std::runtime_error(std::string("CVODE: ") + what + ": " + std::to_string(status));
}

// Objects of CVODE's C interface. The destructor frees them in the order that CVODE requires.
struct Session {
  Session() { demand(SUNContext_Create(nullptr, &context), "context"); }
  ~Session() {
    CVodeFree(&memory);
    if (solver != nullptr) SUNLinSolFree(solver);
    if (matrix != nullptr) SUNMatDestroy(matrix);
    if (y != nullptr) N_VDestroy(y);
    SUNContext_Free(&context);
  }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  SUNContext context = nullptr;
  void* memory = nullptr;
  N_Vector y = nullptr;
  SUNMatrix matrix = nullptr;
  SUNLinearSolver solver = nullptr;
};

}  // namespace

std::vector<std::vector<double>> solveByCvode(const OdeFunctions& functions, const std::vector<double>& start,
                                              double tick, int ticks, const CvodeOptions& options) {
  Session session;
  const int n = functions.dimension;
  session.y = N_VNew_Serial(n, session.context);
  double* values = N_VGetArrayPointer(session.y);
  std::copy(start.begin(), start.end(), values);
  session.memory = CVodeCreate(options.stiff ? CV_BDF : CV_ADAMS, session.context);
  demand(CVodeInit(session.memory, rateOf, 0, session.y), "init");
  demand(CVodeSStolerances(session.memory, options.relative, options.absolute), "tolerances");
  OdeFunctions copy = functions;
  demand(CVodeSetUserData(session.memory, &copy), "user data");
  demand(CVodeSetMaxNumSteps(session.memory, kMaxStepsPerTick), "steps");
  session.matrix = SUNDenseMatrix(n, n, session.context);
  session.solver = SUNLinSol_Dense(session.y, session.matrix, session.context);
  demand(CVodeSetLinearSolver(session.memory, session.solver, session.matrix), "solver");
  demand(CVodeSetJacFn(session.memory, jacobianOf), "Jacobian");

  std::vector<std::vector<double>> trajectory{start};
  for (int i = 1; i <= ticks; ++i) {
    double t = 0;
    demand(CVode(session.memory, tick * i, session.y, &t, CV_NORMAL), "step");
    trajectory.emplace_back(values, values + n);
  }
  return trajectory;
}

}  // namespace lab
