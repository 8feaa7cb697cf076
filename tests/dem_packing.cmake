# Placement of grains.
trackbed_test(packing_place unit trackbed_dem)
trackbed_test(packing_measure verification trackbed_dem)
target_include_directories(packing_measure_test PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/unit)
trackbed_test(packing_path unit trackbed_dem)
trackbed_test(packing_duplicate unit trackbed_dem)
trackbed_test(packing_file unit trackbed_dem)
