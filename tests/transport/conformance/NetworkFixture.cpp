#include "NetworkFixture.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "Recorder.h"
#include "TestSample.h"

namespace Rabit::Conformance
{

using testing::HasSubstr;
using testing::Not;

NetworkFixture::~NetworkFixture()
{
    if (!_file.empty())
    {
        std::filesystem::remove(_file);
    }
}

void NetworkFixture::ExpectDelivery(const TransportSettings &one, const TransportSettings &other)
{
    SampleRecorder recorder;
    const auto writing = Backend().Open(one, {});
    const auto reading = Backend().Open(other, {});
    const auto writer = writing->CreateWriter(TextTopic(), State(), {});
    const auto reader = reading->CreateReader(TextTopic(), State(), {}, recorder.Handler());
    ASSERT_EQ(WriteOnceTaken(*writer, MakeSample(0, std::string(5000, 'x')), 1), WriteResult::Ok);
    ASSERT_TRUE(Net().Until([&] { return recorder.Count() == 1; }));
    EXPECT_EQ(recorder.Texts()[0], std::string(5000, 'x'));
}

void NetworkFixture::ExpectRefusal(const TransportSettings &settings, const std::string &text,
                                   const std::string &setting)
{
    try
    {
        Backend().Open(settings, {});
        ADD_FAILURE() << "not refused";
    }
    catch (const TransportError &error)
    {
        EXPECT_THAT(error.what(), HasSubstr(text));
        EXPECT_THAT(error.what(), Not(HasSubstr("\n")));
        EXPECT_EQ(error.Setting(), setting);
    }
}

std::string NetworkFixture::TemporaryFile(const std::string &text)
{
    // Fast DDS reads a file of one name only once in a process, so each file has another name.
    static int number = 0;
    _file = testing::TempDir() + "rabit-transport-" + std::to_string(getpid()) + "-" +
            std::to_string(++number) + ".xml";
    std::ofstream(_file) << text;
    return _file;
}

}  // namespace Rabit::Conformance
