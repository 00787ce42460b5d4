// The one place that knows whether a function is also compiled for the device.
//
// Everything marked LOAM_FN is always inlined. That is more than speed: kernel sources are compiled once per instruction set, and a
// function that was emitted out of line by two of them would be merged by the linker into one, possibly with instructions that the
// machine lacks.
#pragma once

#if defined(__CUDACC__)
#define LOAM_FN __host__ __device__ __forceinline__
#else
#define LOAM_FN inline __attribute__((always_inline))
#endif
