// A suppression for LeakSanitizer. The parser of IDL, which was built without it, does not free a text that
// it refuses: some hundred bytes to a few kB. Nodes do not parse the texts of others. The program rabit
// does, and ends soon after.
#include "../../sanitizers/Sanitized.h"

#ifdef RABIT_SANITIZED
extern "C" const char *__lsan_default_suppressions();
extern "C" const char *__lsan_default_suppressions()
{
    return "leak:libcycloneddsidl.so\n";
}
#endif
