#pragma once

// Empty: programs written for earlier versions include it.
