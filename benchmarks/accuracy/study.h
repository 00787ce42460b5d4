/* The study: its effects, the rows that they give, and how far it is. */
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "meter.h"

namespace loam::accuracy {

/* One setting of one experiment and one measure of it. What does not apply is left as it is, and empty in the table. */
struct Row {
  std::string effect, name; // of the experiment
  std::string preset;       // of the library, or none
  std::string solver, multiplier;
  double substep = 0;
  std::uint32_t iterations = 0;
  std::size_t particles = 0;
  std::string error_name;
  double error = 0;              // a share of what is right, with its sign where it has one
  double seconds_per_second = 0; // of the processor, for a second of the simulation
  double residual = 0;
};

class Study {
public:
  explicit Study(bool quick) : quick_(quick) {}

  bool quick() const { return quick_; } // fewer settings of fewer experiments

  /* Calls `measure` with one setting after the other. One that makes the simulation fail has the error infinity, under each of `error_names`. */
  void sweep(const std::string &effect, const std::string &name, const std::vector<std::string> &error_names,
             const std::vector<Setting> &settings,
             const std::function<std::vector<double>(const Setting &, Meter &)> &measure);

  void add(Row row) { rows_.push_back(std::move(row)); }
  const std::vector<Row> &rows() const { return rows_; }

  /* Shows on the standard error what is being done. */
  void show(const std::string &what) const;
  void write(const std::string &path) const;

private:
  bool quick_;
  std::vector<Row> rows_;
};

struct Effect {
  const char *name;
  void (*run)(Study &);
};

void beam(Study &study);        // the drop of cantilevers
void one_step(Study &study);    // a single substep of a bent beam against its exact solution
void sand(Study &study);        // the run-out of a slab
void snow(Study &study);        // the shape of a block that was thrown
void dam(Study &study);         // the front of water from a broken dam
void cloth(Study &study);       // the stretch of a sheet, the sag of a strip
void penetration(Study &study); // of sand into what it falls on
void scaling(Study &study);     // with the number of particles, and the stages of a step

/* The library's presets in an experiment whose frames are so long. */
std::vector<Setting> presets(double frame);

/* All forms at each substep and number of iterations. */
std::vector<Setting> combine(const std::vector<Form> &forms, const std::vector<double> &substeps,
                             const std::vector<std::uint32_t> &iterations);

void append(std::vector<Setting> &to, const std::vector<Setting> &more);

} // namespace loam::accuracy
