// Prints the datagrams of all published faults, one fault a line, for vendor_faults_test.py:
//   <name> <vendor> <datagram in hexadecimal digits>...
#include <iomanip>
#include <iostream>
#include <sstream>

#include "faults/Datagrams.h"

int main()
{
    for (const auto &all :
         {Faults::FastDdsFaults(), Faults::FastDdsAnnouncementFaults(), Faults::CycloneDdsFaults()})
    {
        for (const Faults::Fault &fault : all)
        {
            std::ostringstream line;
            line << fault.Name << ' ' << fault.Vendor << std::hex << std::setfill('0');
            for (const auto &datagram : fault.Datagrams)
            {
                line << ' ';
                for (const std::uint8_t byte : datagram)
                {
                    line << std::setw(2) << int{byte};
                }
            }
            std::cout << line.str() << '\n';
        }
    }
}
