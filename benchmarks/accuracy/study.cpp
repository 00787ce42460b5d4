#include "study.h"

#include <chrono>
#include <cstdio>
#include <fstream>
#include <limits>
#include <stdexcept>

namespace loam::accuracy {

void Study::show(const std::string &what) const {
  static const auto start = std::chrono::steady_clock::now();
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  std::fprintf(stderr, "%6.1f s  %4zu rows  %s\n", seconds, rows_.size(), what.c_str());
}

void Study::sweep(const std::string &effect, const std::string &name, const std::vector<std::string> &error_names,
                  const std::vector<Setting> &settings,
                  const std::function<std::vector<double>(const Setting &, Meter &)> &measure) {
  show(effect + ", " + name + ": " + std::to_string(settings.size()) + " settings");
  for (const Setting &setting : settings) {
    Meter meter(setting);
    std::vector<double> errors;
    try {
      errors = measure(setting, meter);
    } catch (const std::runtime_error &) {
      errors.assign(error_names.size(), std::numeric_limits<double>::infinity());
    }
    for (std::size_t k = 0; k < errors.size(); ++k)
      add({effect, name, setting.preset >= 0 ? preset_names[setting.preset] : "", setting.form.solver_name(),
           setting.form.multiplier_name(), setting.preset >= 0 ? meter.substep() : setting.substep,
           setting.preset >= 0 ? meter.iterations() : setting.iterations, meter.particles(), error_names[k], errors[k],
           meter.seconds_per_second(), meter.residual()});
  }
}

void Study::write(const std::string &path) const {
  std::ofstream file(path);
  file.precision(6);
  file << "effect,case,preset,solver,multiplier,substep_s,iterations,particles,error_name,error,seconds_per_second,"
          "residual\n";
  for (const Row &row : rows_)
    file << row.effect << ',' << row.name << ',' << row.preset << ',' << row.solver << ',' << row.multiplier << ','
         << row.substep << ',' << row.iterations << ',' << row.particles << ',' << row.error_name << ',' << row.error << ','
         << row.seconds_per_second << ',' << row.residual << '\n';
  file.close();
  if (!file) throw std::runtime_error("cannot write " + path);
}

void append(std::vector<Setting> &to, const std::vector<Setting> &more) { to.insert(to.end(), more.begin(), more.end()); }

std::vector<Setting> presets(double frame) {
  std::vector<Setting> settings;
  for (int preset = LOAM_ACCURACY_PRESET_FAST; preset <= LOAM_ACCURACY_PRESET_REFERENCE; ++preset)
    settings.push_back({{}, frame, 1, preset});
  return settings;
}

std::vector<Setting> combine(const std::vector<Form> &forms, const std::vector<double> &substeps,
                             const std::vector<std::uint32_t> &iterations) {
  std::vector<Setting> settings;
  for (const Form &form : forms)
    for (const double substep : substeps)
      for (const std::uint32_t count : iterations) settings.push_back({form, substep, count});
  return settings;
}

} // namespace loam::accuracy
