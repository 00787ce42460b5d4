// What stands for the cloths of a solver in a build without cloth: there are none, and the compiler leaves out what would deal with them.
#pragma once

#include "scene/error.h"
#include "solver/cloth_solver.h"

namespace loam {

template <class Executor> class NoCloth final : public ClothBackend {
public:
  using Substep = typename ClothSolver<Executor>::Substep;

  NoCloth(Executor &, std::size_t) {}

  int add(const SolverCloth &) override {
    throw Error(LOAM_ERROR_NOT_BUILT, "cloth is left out of this build of the library (LOAM_CLOTH)");
  }
  void remove(int) override {}
  void set_attachments(int, const std::vector<SolverAttachment> &) override {}
  void set_wind(int, const ClothWind &) override {}
  std::uint32_t vertex_count(int) const override { return 0; }
  std::vector<Row> positions(int) override { return {}; }
  std::vector<TornCorner> torn_corners(int) const override { return {}; }
  bool could_be_torn(int, const std::vector<TornCorner> &) const override { return false; }
  void set_torn_corners(int, const std::vector<TornCorner> &) override {}
  void list_state(int, const std::vector<TornCorner> &, std::uint32_t, std::vector<StateSection> &) override {}
  void map(int, loam_cloth_view &) override {}

  static constexpr bool empty() { return true; }
  static constexpr bool any_self_contact() { return false; }
  static constexpr std::uint64_t bytes() { return 0; }
  static constexpr std::uint64_t self_contact_bytes() { return 0; }
  static constexpr std::uint64_t hash(std::uint64_t hash) { return hash; }
  static constexpr float least_inverse_mass() { return LeastInverseMass::identity(); }
  void shift_origin(const Vec3<float> &) {}
  template <class F> void for_each_sheet(F &&) {}

  void find_contacts(const Substep &) {}
  void prepare(const Substep &, int *) {}
  void solve(const Substep &) {}
  void solve_contacts(const Substep &) {}
  void solve_self_contacts(const Substep &) {}
  void solve_particle_contacts(const Substep &) {}
  void finish(const Substep &, int *, Reactions) {}
  void sweep_particles(const Substep &, bool = true) {}
  void advance(const Substep &) {}
  void begin_step() {}
  void tear(float) {}
  static constexpr std::uint64_t tear_count() { return 0; }
  static constexpr double greatest_stretch() { return 0; }
  static constexpr std::size_t row_count() { return 0; }
  static constexpr std::uint64_t constraint_count() { return 0; }
  static constexpr std::uint64_t vertex_count() { return 0; }
  static constexpr std::uint64_t contact_count() { return 0; }
  static constexpr std::uint64_t self_contact_count() { return 0; }
  static constexpr std::uint64_t particle_contact_count() { return 0; }
};

} // namespace loam
