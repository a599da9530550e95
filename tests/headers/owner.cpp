// The program that owns the precompiled header of the tests.
int main() {}
