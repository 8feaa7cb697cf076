# Overlap geometry, separating axes, normal contact laws.
trackbed_test(contact_overlap unit trackbed_dem)
trackbed_test(contact_separation unit trackbed_dem)
trackbed_test(closest_point unit trackbed_dem)
trackbed_test(contact_feature unit trackbed_dem)
trackbed_test(contact_law verification trackbed_dem)

find_package(CGAL REQUIRED)
trackbed_test(contact_exact verification trackbed_dem CGAL::CGAL)

# Random bodies for as long as one likes: build/tests/fuzz_pairs SECONDS. In the suite a fixed number.
function(fuzzer name pairs seed)
  add_executable(fuzz_${name} ${CMAKE_CURRENT_SOURCE_DIR}/hard/fuzz_${name}.cc)
  target_include_directories(fuzz_${name} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/unit)
  target_link_libraries(fuzz_${name} PRIVATE trackbed_dem CGAL::CGAL)
  add_test(NAME hard/fuzz_${name} COMMAND fuzz_${name} --pairs ${pairs} --seed ${seed})
  set_tests_properties(hard/fuzz_${name} PROPERTIES LABELS hard TIMEOUT 120)
endfunction()
fuzzer(pairs 1000 2)
fuzzer(dilated 200 1)
fuzzer(surface 500 1)
fuzzer(walk 250 3)

find_package(benchmark)
if(benchmark_FOUND)
  add_executable(contact_benchmark ${CMAKE_CURRENT_SOURCE_DIR}/benchmarks/contact_benchmark.cc)
  target_link_libraries(contact_benchmark PRIVATE trackbed_dem benchmark::benchmark)
endif()
