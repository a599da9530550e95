// A program that is given a type at run time.
#include <rabit/dynamic/DynamicType.h>

#include <iostream>

int main()
{
    const Rabit::ParsedType parsed = Rabit::DynamicType::Parse(
        "module Late { struct Report { @default(7) long number; }; };", "Late::Report");
    std::cout << (parsed.Type ? parsed.Type->ToJson(parsed.Type->DefaultSample()).value_or("?")
                              : parsed.Reason)
              << "\n";
    const Rabit::ParsedType none = Rabit::DynamicType::Parse("struct S { Unknown u; };", "S");
    std::cout << none.Reason << "\n";
    return parsed.Type && !none.Type ? 0 : 1;
}
