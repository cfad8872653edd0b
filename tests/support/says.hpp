// Messages for users are part of what is tested.
#pragma once

#include <gtest/gtest.h>

#include <string>

#define EXPECT_SAYS(message, part) EXPECT_NE((message).find(part), std::string::npos) << (message)
