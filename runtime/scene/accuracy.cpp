#include "scene/accuracy.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "scene/checks.h"

namespace loam {

namespace {

constexpr std::uint32_t least_iterations = 2; // of a budget: one alone cannot take back what it gave too much

// The least number of substeps with which `travel` is at most `most`, without those of rounding.
double substeps_for(double travel, double most) { return std::ceil(travel / most * (1 - 1e-9)); }

struct Asked {
  double substeps;
  std::uint32_t reason;
};

Asked greatest(std::initializer_list<Asked> all) {
  return *std::max_element(all.begin(), all.end(), [](const Asked &a, const Asked &b) { return a.substeps < b.substeps; });
}

// Soft sheets hang too long where substeps are longer than this times the Courant number: see the sheet in docs/accuracy.html. Stiff ones do not, for their
// threads are solved as a whole.
constexpr double cloth_substep = 1.0 / 1440;

// What falls from rest goes g h^2 in a substep.
double substeps_for_weight(const StepNeeds &needs, double share_of_radius) {
  return std::ceil(needs.seconds * std::sqrt(needs.gravity / (share_of_radius * needs.kernel_radius)) * (1 - 1e-9));
}

// With fewer, matter is slowed down, or falls through the spacing of what it lies on.
Asked asked_by_stability(const StepNeeds &needs) {
  return greatest({{1, LOAM_SUBSTEPS_LEAST},
                   {substeps_for_weight(needs, 1), LOAM_SUBSTEPS_WEIGHT},
                   {substeps_for(needs.speed * needs.seconds, needs.kernel_radius), LOAM_SUBSTEPS_SPEED}});
}

StepChoice bounded(const Asked &asked, std::uint32_t most, std::uint32_t iterations) {
  if (asked.substeps > most) return {most, iterations, LOAM_SUBSTEPS_MOST};
  return {static_cast<std::uint32_t>(asked.substeps), iterations, asked.reason};
}

} // namespace

loam_accuracy_def default_accuracy() {
  loam_accuracy_def def = {};
  def.struct_size = sizeof def;
  def.mode = LOAM_ACCURACY_FIXED;
  def.substeps = 16;
  def.iterations = 5;
  def.most_substeps = 256;
  def.courant = 3;
  return def;
}

loam_accuracy_def accuracy_preset(std::uint32_t preset) {
  check_choice("preset", preset, LOAM_ACCURACY_PRESET_REFERENCE);
  loam_accuracy_def def = default_accuracy();
  def.substeps = 0;
  switch (preset) {
  case LOAM_ACCURACY_PRESET_FAST:
    def.iterations = 3;
    def.most_substeps = 64;
    break;
  case LOAM_ACCURACY_PRESET_BALANCED:
    def.iterations = 4;
    def.courant = 1.5f;
    break;
  case LOAM_ACCURACY_PRESET_ACCURATE:
    // Short substeps bring more than iterations, see docs/accuracy.html.
    def.iterations = 3;
    def.courant = 0.5f;
    def.most_substeps = 2048;
    break;
  default:
    def.mode = LOAM_ACCURACY_TOLERANCE;
    def.tolerance = 1e-3f;
    def.iterations = 200;
    def.courant = 0.25f;
    def.most_substeps = 10000;
    break;
  }
  return def;
}

void check_accuracy(const loam_accuracy_def &def) {
  check_choice("mode", def.mode, LOAM_ACCURACY_BUDGET);
  const bool tolerance = def.mode == LOAM_ACCURACY_TOLERANCE, budget = def.mode == LOAM_ACCURACY_BUDGET;
  check_range("substeps", def.substeps, 0, 10000);
  check_range("iterations", def.iterations, tolerance ? 3 : budget ? least_iterations : 1, 1000);
  check_range("most_substeps", def.most_substeps, 1, 10000);
  check_range("courant", static_cast<double>(def.courant), static_cast<double>(0.01f), 100);
  if (tolerance) {
    if (!(def.tolerance >= LOAM_LEAST_TOLERANCE && def.tolerance <= 0.5f))
      throw Error(LOAM_ERROR_INVALID_ARGUMENT,
                  format("tolerance is %g; it must be from %g, the least that single precision reaches, to 0.5",
                         static_cast<double>(def.tolerance), static_cast<double>(LOAM_LEAST_TOLERANCE)));
  } else if (def.tolerance != 0.0f) {
    throw Error(LOAM_ERROR_INVALID_ARGUMENT,
                format("tolerance is %g and mode is %u; only with TOLERANCE (%u) it may be other than 0",
                       static_cast<double>(def.tolerance), def.mode, static_cast<unsigned>(LOAM_ACCURACY_TOLERANCE)));
  }
  if (budget) {
    check_above("budget", static_cast<double>(def.budget), 0, 10);
    if (def.substeps != 0)
      throw Error(LOAM_ERROR_INVALID_ARGUMENT,
                  format("substeps is %u and mode is BUDGET, which chooses them: it must be 0", def.substeps));
  } else if (def.budget != 0.0f) {
    throw Error(LOAM_ERROR_INVALID_ARGUMENT,
                format("budget is %g and mode is %u; only with BUDGET (%u) it may be other than 0",
                       static_cast<double>(def.budget), def.mode, static_cast<unsigned>(LOAM_ACCURACY_BUDGET)));
  }
}

StepChoice choose_substeps(const loam_accuracy_def &def, const StepNeeds &needs) {
  if (def.substeps != 0) return {def.substeps, def.iterations, LOAM_SUBSTEPS_GIVEN};
  const double courant = static_cast<double>(def.courant), share = std::min(0.5, courant / 6);
  return bounded(
      greatest({{1, LOAM_SUBSTEPS_LEAST},
                {substeps_for_weight(needs, 0.5), LOAM_SUBSTEPS_WEIGHT},
                {substeps_for(needs.speed * needs.seconds, share * needs.kernel_radius), LOAM_SUBSTEPS_SPEED},
                {needs.cloth ? substeps_for(needs.seconds, courant * cloth_substep) : 1, LOAM_SUBSTEPS_CLOTH},
                {substeps_for(needs.wave_speed * needs.seconds, courant * needs.kernel_radius), LOAM_SUBSTEPS_STIFFNESS}}),
      def.most_substeps, def.iterations);
}

StepChoice BudgetControl::choose(const loam_accuracy_def &def, const StepNeeds &needs, double load) const {
  const StepChoice least = bounded(asked_by_stability(needs), def.most_substeps, least_iterations);
  if (learnt_ == 0 || !(load > 0)) return least;

  const double substep = per_substep_ * load, iteration = per_iteration_ * load;
  const auto cost = [&](double n, double i) { return n * (substep + i * iteration); };
  const double budget = static_cast<double>(def.budget),
               target = budget - std::clamp(0.25 * debt_, -0.5 * budget, 0.5 * budget);
  StepChoice choice = least;
  choice.least_budget = cost(least.substeps, least.iterations);
  choice.exceeds_budget = choice.least_budget > budget;

  // Shorter substeps first, see docs/accuracy.html; what is left over once the substeps are whole buys iterations.
  const double paid = std::floor(target / (substep + def.iterations * iteration));
  if (paid >= least.substeps) {
    choice.reason = paid > def.most_substeps ? LOAM_SUBSTEPS_MOST : LOAM_SUBSTEPS_BUDGET;
    choice.substeps = static_cast<std::uint32_t>(std::min<double>(paid, def.most_substeps));
  }
  const auto paid_iterations = [&](double n) { return std::floor((target / n - substep) / iteration); };
  double iterations = paid_iterations(choice.substeps);
  // Few substeps with many iterations: one more with at least half of them is more accurate.
  if (choice.substeps < def.most_substeps && iterations > 1.5 * def.iterations &&
      paid_iterations(choice.substeps + 1) >= 0.5 * def.iterations) {
    iterations = paid_iterations(++choice.substeps);
    choice.reason = LOAM_SUBSTEPS_BUDGET;
  }
  choice.iterations = static_cast<std::uint32_t>(std::clamp<double>(iterations, least_iterations, 1000));
  return choice;
}

void BudgetControl::learn(const StepChoice &choice, double seconds, double iteration_seconds, double load, double budget) {
  if (!(load > 0 && seconds > 0)) return;
  const double n = choice.substeps * load;
  double per_substep = std::max(0.0, seconds - iteration_seconds) / n;
  double per_iteration = std::max(iteration_seconds, 0.01 * seconds) / (n * choice.iterations);
  // The first step is none to learn from for long: memory is new, caches are cold. Nor is one that the machine was busy with something else in.
  const double share = learnt_ < 2 ? 1 : 0.2;
  if (learnt_ >= 2) {
    per_substep = std::min(per_substep, 3 * per_substep_);
    per_iteration = std::min(per_iteration, 3 * per_iteration_);
    debt_ = std::clamp(debt_ + (seconds - budget), -budget, 8 * budget);
  }
  per_substep_ += share * (per_substep - per_substep_);
  per_iteration_ += share * (per_iteration - per_iteration_);
  ++learnt_;
}

double iteration_seconds(const Schedule &schedule) {
  double seconds = 0;
  const auto add = [&](int stage) {
    if (stage >= 0) seconds += schedule.stages()[static_cast<std::size_t>(stage)].seconds;
  };
  for (const int stage : schedule.solve) add(stage);
  for (const int stage : {schedule.position_correction, schedule.solve_cloth, schedule.cloth_self_contact,
                          schedule.cloth_particles, schedule.contacts, schedule.cloth_contacts, schedule.displace_fluids})
    add(stage);
  return seconds;
}

} // namespace loam
