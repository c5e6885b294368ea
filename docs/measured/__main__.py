import measured

measured.main()
