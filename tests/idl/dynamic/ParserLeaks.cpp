// What LeakSanitizer is told about the parser of IDL, which was built without it: it does not free what it
// has read of a text that it then refuses, some hundred bytes to a few kB. Nodes do not parse the texts of
// others; the program rabit does, and ends soon after.
#if defined(__SANITIZE_ADDRESS__)
extern "C" const char *__lsan_default_suppressions();
extern "C" const char *__lsan_default_suppressions()
{
    return "leak:libcycloneddsidl.so\n";
}
#endif
