/* Compiled and linked against the library, not run on matter: that the loaded library is the one whose headers were found. */
#include <loam/loam.h>
#include <stdio.h>

int main(void) {
  uint32_t major = 0, minor = 0, patch = 0;
  if (loam_version(&major, &minor, &patch) != LOAM_OK) return 1;
  printf("Loam %u.%u.%u\n", (unsigned)major, (unsigned)minor, (unsigned)patch);
  return major == LOAM_VERSION_MAJOR && minor == LOAM_VERSION_MINOR && patch == LOAM_VERSION_PATCH ? 0 : 1;
}
