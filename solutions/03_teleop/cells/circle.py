drive(ahead=0.2, turn=0.4)
