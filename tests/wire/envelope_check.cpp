// Opens the datagrams that envelope_reader.py made, in the file that is the argument. Without an argument,
// prints the vectors that the code makes now, for envelope_vectors.txt.
#include <cstdio>
#include <exception>
#include <fstream>

#include "EnvelopeVectors.h"

int main(int argc, char **argv)
{
    try
    {
        if (argc < 2)
        {
            std::fputs(Rabit::Test::LinesOf(Rabit::Test::MakeEnvelopeVectors()).c_str(), stdout);
            return 0;
        }
        std::ifstream file(argv[1]);
        const std::string wrong = Rabit::Test::WrongAtB(Rabit::Test::ReadVectors(file));
        std::printf("%s\n", wrong.empty() ? "all open" : wrong.c_str());
        return wrong.empty() ? 0 : 1;
    }
    catch (const std::exception &error)
    {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
