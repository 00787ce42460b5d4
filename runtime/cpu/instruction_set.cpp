// Which instruction sets this machine has, and their kernels.
#include <loam/world.h>

#include "cpu/kernel_table.h"

namespace loam {

namespace portable {
const KernelTable *get_table();
}
#if defined(LOAM_SSE4_KERNELS)
namespace sse4 {
const KernelTable *get_table();
}
#endif
#if defined(LOAM_AVX2_KERNELS)
namespace avx2 {
const KernelTable *get_table();
}
#endif
#if defined(LOAM_AVX512_KERNELS)
namespace avx512 {
const KernelTable *get_table();
}
#endif

// __builtin_cpu_supports also asks whether the operating system saves the wide registers.
#if defined(LOAM_SSE4_KERNELS) || defined(LOAM_AVX2_KERNELS) || defined(LOAM_AVX512_KERNELS)
static bool has_sse4() {
  return __builtin_cpu_supports("sse4.2") && __builtin_cpu_supports("pclmul") && __builtin_cpu_supports("ssse3");
}
#endif
#if defined(LOAM_AVX2_KERNELS) || defined(LOAM_AVX512_KERNELS)
static bool has_avx2() {
  return has_sse4() && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi") &&
         __builtin_cpu_supports("bmi2");
}
#endif
#if defined(LOAM_AVX512_KERNELS)
static bool has_avx512() {
  return has_avx2() && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
         __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512cd");
}
#endif

const KernelTable *kernel_table(unsigned instruction_set) {
  switch (instruction_set) {
  case LOAM_INSTRUCTION_SET_PORTABLE:
    return portable::get_table();
#if defined(LOAM_SSE4_KERNELS)
  case LOAM_INSTRUCTION_SET_SSE4:
    return has_sse4() ? sse4::get_table() : nullptr;
#endif
#if defined(LOAM_AVX2_KERNELS)
  case LOAM_INSTRUCTION_SET_AVX2:
    return has_avx2() ? avx2::get_table() : nullptr;
#endif
#if defined(LOAM_AVX512_KERNELS)
  case LOAM_INSTRUCTION_SET_AVX512:
    return has_avx512() ? avx512::get_table() : nullptr;
#endif
  default:
    return nullptr;
  }
}

unsigned best_instruction_set() {
  constexpr unsigned widest_first[] = {LOAM_INSTRUCTION_SET_AVX512, LOAM_INSTRUCTION_SET_AVX2, LOAM_INSTRUCTION_SET_SSE4};
  for (const unsigned candidate : widest_first)
    if (kernel_table(candidate) != nullptr) return candidate;
  return LOAM_INSTRUCTION_SET_PORTABLE;
}

const char *instruction_set_name(unsigned instruction_set) {
  switch (instruction_set) {
  case LOAM_INSTRUCTION_SET_PORTABLE:
    return "portable";
  case LOAM_INSTRUCTION_SET_SSE4:
    return "SSE4.2";
  case LOAM_INSTRUCTION_SET_AVX2:
    return "AVX2";
  case LOAM_INSTRUCTION_SET_AVX512:
    return "AVX-512";
  default:
    return "none";
  }
}

} // namespace loam
