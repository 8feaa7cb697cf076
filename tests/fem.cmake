# Finite elements. Tests that look at the library's inner parts see deal.II; users of its header do not.
trackbed_test(fem_body unit trackbed_fem)
trackbed_test(fem_statics verification trackbed_fem)
trackbed_test(fem_dynamics verification trackbed_fem)
add_executable(fem_step_benchmark ${CMAKE_CURRENT_LIST_DIR}/benchmarks/fem_step_benchmark.cc)
target_link_libraries(fem_step_benchmark PRIVATE trackbed_fem)
