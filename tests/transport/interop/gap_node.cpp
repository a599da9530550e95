// Writes or reads one topic without a gateway, for gap_test.py.
//
// As "write": prints "matched", and then for each line of its standard input writes a sample with that text,
// reliable or best effort, and prints "wrote <text>". As "read": reads with best effort, and prints "got
// <text>" for each sample. Texts are as long as the first word says: "c 1000" is a c and 999 spaces. Ends
// with its standard input.
#include <rabit/transport/TransportFactory.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdint>
#include <exception>
#include <iostream>
#include <sstream>
#include <string>

#include "../../Eventually.h"
#include "../conformance/TestSample.h"

namespace
{

using namespace Rabit::Conformance;

struct Options
{
    std::string Transport, Role;
    bool Reliable = false;
};

void WriteLines(Rabit::TransportSession &session, bool reliable)
{
    const auto writer = session.CreateWriter(TextTopic(), reliable ? State() : Telemetry(), {});
    RabitTest::Eventually([&] { return writer->MatchedReaders() > 0; });
    std::cout << "matched" << std::endl;
    std::int64_t number = 0;
    for (std::string line; std::getline(std::cin, line);)
    {
        std::istringstream words(line);
        std::string text;
        std::size_t size = 0;
        words >> text >> size;
        text.resize(std::max(text.size(), size), ' ');
        WriteOnceTaken(*writer, MakeSample(1, text), ++number);
        std::cout << "wrote " << line << std::endl;
    }
}

void ReadLines(Rabit::TransportSession &session)
{
    const auto reader = session.CreateReader(TextTopic(), Telemetry(), {},
                                             [](Rabit::SampleBytes bytes, const Rabit::SampleInfo &)
                                             {
                                                 const std::string text = TextOf(bytes);
                                                 std::cout << "got " + text.substr(0, text.find(' ')) + "\n"
                                                           << std::flush;
                                             });
    for (std::string line; std::getline(std::cin, line);)
    {
    }
}

}  // namespace

int main(int argc, char **argv)
{
    CLI::App app{"One end of a topic"};
    Options options;
    app.add_option("transport", options.Transport)->required();
    app.add_option("role", options.Role)->required()->check(CLI::IsMember({"write", "read"}));
    app.add_flag("--reliable", options.Reliable);
    CLI11_PARSE(app, argc, argv);
    try
    {
        Rabit::TransportSettings settings;
        settings.Node = options.Role == "write" ? "writing" : "reading";
        settings.Incarnation = 1;
        const auto session = Rabit::MakeTransport(options.Transport)->Open(settings, {});
        options.Role == "write" ? WriteLines(*session, options.Reliable) : ReadLines(*session);
        return 0;
    }
    catch (const std::exception &error)
    {
        std::cerr << error.what() << "\n";
        return 1;
    }
}
