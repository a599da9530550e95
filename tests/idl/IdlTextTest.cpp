// The IDL text of a type is a complete IDL file that gives the same type again.
#include "SampleTest.h"

#include "RunIdlc.h"

#include <rabit/idl/MessageType.h>
#include <rabit/idl/MessageTypeRegistry.h>

#include <fstream>

namespace
{

TEST_EACH_SAMPLE(IdlText, GivesTheSameTextAgainWhenCompiled)
{
    const std::string text = Rabit::MessageTypeRegistry::Of(message)->IdlText();
    const ScratchDirectory scratch;
    std::ofstream(scratch.Path() / "again.idl") << text;
    const IdlcResult result = RunIdlc(scratch.Path() / "again.idl", scratch.Path());
    ASSERT_EQ(result.ExitCode, 0) << result.Errors << text;
    EXPECT_EQ(result.Errors, "");
    EXPECT_NE(ReadFile(scratch.Path() / "again.idl.cpp").find("R\"idl(" + text + ")idl\""),
              std::string::npos);
}

}  // namespace
