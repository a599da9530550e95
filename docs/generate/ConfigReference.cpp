// Prints the manual's reference of configuration files, from the table that the loader uses.
#include <iostream>
#include <string>

#include "configuration/ConfigSections.h"

namespace
{

void PrintKey(const Rabit::ConfigKey &key)
{
    std::cout << '`' << key.Name << "`\n: " << key.Value;
    if (key.IsRequired)
    {
        std::cout << ". **Required.**";
    }
    else if (!key.Default.empty())
    {
        std::cout << ". Default: `" << key.Default << '`';
    }
    std::cout << "\n\n";
    if (!key.Help.empty())
    {
        std::cout << "  " << key.Help << "\n\n";
    }
    std::cout << "  Example: `" << key.Name << ": " << key.Example << "`\n\n";
}

}  // namespace

int main()
{
    for (const Rabit::ConfigSection &section : Rabit::ConfigSections())
    {
        std::cout << "## " << (section.Path.empty() ? "Top level" : '`' + section.Path + '`') << "\n\n"
                  << section.Help << "\n\n";
        for (const Rabit::ConfigKey &key : section.Keys)
        {
            PrintKey(key);
        }
    }
}
