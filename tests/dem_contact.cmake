# Overlap geometry, separating axes, normal contact laws.
trackbed_test(contact_overlap unit trackbed_dem)
trackbed_test(contact_separation unit trackbed_dem)
trackbed_test(closest_point unit trackbed_dem)
trackbed_test(contact_feature unit trackbed_dem)
trackbed_test(contact_law verification trackbed_dem)

find_package(CGAL REQUIRED)
trackbed_test(contact_exact verification trackbed_dem CGAL::CGAL)

# Random pairs for as long as one likes: build/tests/fuzz_pairs SECONDS. In the suite a fixed number.
add_executable(fuzz_pairs ${CMAKE_CURRENT_SOURCE_DIR}/hard/fuzz_pairs.cc)
target_include_directories(fuzz_pairs PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/unit)
target_link_libraries(fuzz_pairs PRIVATE trackbed_dem CGAL::CGAL)
add_test(NAME hard/fuzz_pairs COMMAND fuzz_pairs --pairs 1000 --seed 2)
set_tests_properties(hard/fuzz_pairs PROPERTIES LABELS hard TIMEOUT 120)
add_executable(fuzz_dilated ${CMAKE_CURRENT_SOURCE_DIR}/hard/fuzz_dilated.cc)
target_include_directories(fuzz_dilated PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/unit)
target_link_libraries(fuzz_dilated PRIVATE trackbed_dem CGAL::CGAL)
add_test(NAME hard/fuzz_dilated COMMAND fuzz_dilated --pairs 200 --seed 1)
set_tests_properties(hard/fuzz_dilated PROPERTIES LABELS hard TIMEOUT 120)

find_package(benchmark)
if(benchmark_FOUND)
  add_executable(contact_benchmark ${CMAKE_CURRENT_SOURCE_DIR}/benchmarks/contact_benchmark.cc)
  target_link_libraries(contact_benchmark PRIVATE trackbed_dem benchmark::benchmark)
endif()
