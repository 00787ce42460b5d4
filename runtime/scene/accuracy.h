// How many substeps and iterations a step gets. See include/loam/accuracy.h.
#pragma once

#include <cstdint>

#include <loam/accuracy.h>

#include "schedule/schedule.h"

namespace loam {

loam_accuracy_def default_accuracy();
loam_accuracy_def accuracy_preset(std::uint32_t preset);

// Throws Error INVALID_ARGUMENT naming the field.
void check_accuracy(const loam_accuracy_def &def);

// What asks for substeps at the beginning of a step.
struct StepNeeds {
  double seconds;
  double kernel_radius;
  double speed;       // of the fastest matter, m/s
  double wave_speed;  // of the stiffest, m/s
  double gravity;     // m/s^2
  bool cloth = false; // is there any?
};

struct StepChoice {
  std::uint32_t substeps, iterations;
  std::uint32_t reason;    // LOAM_SUBSTEPS_*
  double least_budget = 0; // seconds; with a budget
  bool exceeds_budget = false;
};

// Of a fixed choice or a tolerance.
StepChoice choose_substeps(const loam_accuracy_def &def, const StepNeeds &needs);

// Keeps steps to a budget: learns what a substep and an iteration cost from the steps that were done.
class BudgetControl {
public:
  // `load` is what costs grow with: particles and vertices.
  StepChoice choose(const loam_accuracy_def &def, const StepNeeds &needs, double load) const;

  // A step as chosen took so long, so much of it in stages that run once an iteration.
  void learn(const StepChoice &choice, double seconds, double iteration_seconds, double load, double budget);

  // What was learnt is forgotten.
  void reset() { *this = BudgetControl(); }
  // What earlier steps took too much or too little does not count.
  void forgive() { debt_ = 0; }

private:
  double per_substep_ = 0, per_iteration_ = 0; // seconds per load
  double debt_ = 0;                            // seconds over the budget so far
  int learnt_ = 0;                             // steps
};

// Of the stages of a schedule, those that run once an iteration.
double iteration_seconds(const Schedule &schedule);

} // namespace loam
