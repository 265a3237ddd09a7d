// The program `broadside`.
#include "broadside/program.hpp"

int main(int count, char** values) { return broadside::run_program(count, values); }
